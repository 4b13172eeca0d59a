//! Shadows against exact rationals of unbounded integers, and against the machine where that rounds nothing.

mod decisions;

use std::collections::BTreeMap;

use emu::machine::Config;
use emu::octets::Memory;
use emu::registers::Registers;
use emu::shadow::{LongReal, ShadowNumber};
use emu::stepper::{Lone, Stepper};
use isa::{Isa, Kind, Op, Program};
use num_bigint::{BigInt, Sign};
use proptest::prelude::*;
use testing::check;

use super::builder::program;

fn shadowed<'a>(config: &'a Config, isa: &'a Isa, program: &'a Program, registers: Registers) -> Stepper<'a> {
    let memory = Memory::new(vec![0; 256]);
    let lone = Lone { config, isa, program, registers, memory, message: None, step_limit: 10_000 };
    Stepper::new(lone).unwrap().with_shadow(None)
}

/// An exact rational number, its denominator positive.
#[derive(Clone, Debug)]
struct Exact(BigInt, BigInt);

impl Exact {
    fn whole(n: i64) -> Exact {
        Exact(n.into(), 1.into())
    }

    fn of(real: &LongReal) -> Exact {
        let (is_negative, digits, exponent) = real.binary();
        let words: Vec<u32> = digits.iter().flat_map(|digit| [*digit as u32, (*digit >> 32) as u32]).collect();
        let sign = if is_negative { Sign::Minus } else { Sign::Plus };
        Exact(BigInt::from_slice(sign, &words), 1.into()).scaled(exponent - 256)
    }

    fn plus(&self, other: &Exact) -> Exact {
        Exact(&self.0 * &other.1 + &other.0 * &self.1, &self.1 * &other.1)
    }

    fn minus(&self, other: &Exact) -> Exact {
        self.plus(&Exact(-&other.0, other.1.clone()))
    }

    fn times(&self, other: &Exact) -> Exact {
        Exact(&self.0 * &other.0, &self.1 * &other.1)
    }

    fn over(&self, other: &Exact) -> Option<Exact> {
        match other.0.sign() {
            Sign::NoSign => None,
            Sign::Plus => Some(Exact(&self.0 * &other.1, &self.1 * &other.0)),
            Sign::Minus => Some(Exact(-&self.0 * &other.1, -&self.1 * &other.0)),
        }
    }

    fn scaled(&self, by: i32) -> Exact {
        match by {
            0.. => Exact(self.0.clone() << by as usize, self.1.clone()),
            _ => Exact(self.0.clone(), self.1.clone() << -by as usize),
        }
    }

    /// The root with 300 bits behind the point.
    fn root(&self) -> Option<Exact> {
        let square: BigInt = (self.0.clone() << 600usize) / &self.1;
        (self.0.sign() != Sign::Minus).then(|| Exact(square.sqrt(), BigInt::from(1) << 300usize))
    }

    fn magnitude(&self) -> Exact {
        Exact(self.0.magnitude().clone().into(), self.1.clone())
    }

    /// The number is at most another one.
    fn is_at_most(&self, other: &Exact) -> bool {
        &self.0 * &other.1 <= &other.0 * &self.1
    }
}

/// Exact numbers of registers by file, number and component; those that are not there are the machine's.
struct Model {
    numbers: BTreeMap<(char, u8, usize), Exact>,
    largest: Exact,
}

/// An instruction of a straight-line program, its operands in the order of the row.
type Straight = (Op, Vec<i64>);

impl Model {
    fn get(&self, registers: &Registers, file: char, number: u8, k: usize) -> Exact {
        let raw = || match file {
            's' => registers.scalar(number).into(),
            'v' => registers.vector(number)[k].into(),
            _ => registers.wide(number),
        };
        self.numbers.get(&(file, number, k)).cloned().unwrap_or_else(|| Exact::whole(raw()))
    }

    /// Exact numbers that the instruction writes; `before` are the machine's registers, which decide.
    fn execute(&mut self, (op, operands): &Straight, before: &Registers) -> Vec<((char, u8, usize), Option<Exact>)> {
        let number = |at: usize| operands[at] as u8;
        let s = |at: usize| self.get(before, 's', number(at), 0);
        let v = |at: usize| [0, 1, 2].map(|k| self.get(before, 'v', number(at), k));
        let w = |at: usize| self.get(before, 'w', number(at), 0);
        let raw = |at: usize| i64::from(before.scalar(number(at)));
        let shift = |at: usize| operands[at] as i32;
        let dot = |a: &[Exact; 3], b: &[Exact; 3]| a[0].times(&b[0]).plus(&a[1].times(&b[1])).plus(&a[2].times(&b[2]));
        let cross = |a: &[Exact; 3], b: &[Exact; 3]| -> [Exact; 3] {
            [(1, 2), (2, 0), (0, 1)].map(|(j, k)| a[j].times(&b[k]).minus(&a[k].times(&b[j])))
        };
        let scalar = |exact: Option<Exact>| vec![(('s', number(0), 0), exact)];
        let wide = |exact: Option<Exact>| vec![(('w', number(0), 0), exact)];
        let vector = |exact: [Exact; 3]| {
            exact.into_iter().enumerate().map(|(k, exact)| (('v', number(0), k), Some(exact))).collect()
        };
        let is_divisible = |at: usize, is_wide: bool| {
            if is_wide { before.wide(number(at)) != 0 } else { before.scalar(number(at)) != 0 }
        };
        // Nothing is rounded: a shift right is a division by a power of two. Choices, as of abs and min, follow the machine's numbers.
        match op {
            Op::add => scalar(Some(s(1).plus(&s(2)))),
            Op::sub => scalar(Some(s(1).minus(&s(2)))),
            Op::neg => scalar(Some(Exact::whole(0).minus(&s(1)))),
            Op::abs => scalar(Some(if raw(1) < 0 { Exact::whole(0).minus(&s(1)) } else { s(1) })),
            Op::mul => scalar(Some(s(1).times(&s(2)).scaled(-shift(3)))),
            // Where the machine divides by 0 or takes the root of less, the shadow has nothing to say.
            Op::div => {
                let quotient = s(1).over(&s(2)).map(|quotient| quotient.scaled(shift(3)));
                scalar(quotient.filter(|_| is_divisible(2, false)))
            }
            Op::min => scalar(Some(if raw(2) < raw(1) { s(2) } else { s(1) })),
            Op::max => scalar(Some(if raw(2) > raw(1) { s(2) } else { s(1) })),
            Op::rshift => scalar(Some(s(1).scaled(-shift(2)))),
            Op::lshift => scalar(Some(s(1).scaled(shift(2)))),
            Op::scale => scalar(Some(s(1).scaled(-raw(2).clamp(-63, 63) as i32))),
            Op::vadd => vector([0, 1, 2].map(|k| v(1)[k].plus(&v(2)[k]))),
            Op::vsub => vector([0, 1, 2].map(|k| v(1)[k].minus(&v(2)[k]))),
            Op::vmul => vector([0, 1, 2].map(|k| v(1)[k].times(&v(2)[k]).scaled(-shift(3)))),
            Op::vscale => vector(v(1).map(|a| a.times(&s(2)).scaled(-shift(3)))),
            Op::vdot => scalar(Some(dot(&v(1), &v(2)).scaled(-shift(3)))),
            Op::vcross => vector(cross(&v(1), &v(2)).map(|a| a.scaled(-shift(3)))),
            Op::vsplat => vector([s(1), s(1), s(1)]),
            Op::vget => scalar(Some(v(1)[operands[2] as usize].clone())),
            Op::wmul => wide(Some(s(1).times(&s(2)))),
            Op::wmac => wide(Some(w(0).plus(&s(1).times(&s(2))))),
            Op::wmsub => wide(Some(w(0).minus(&s(1).times(&s(2))))),
            Op::wdot => wide(Some(dot(&v(1), &v(2)))),
            Op::wadd => wide(Some(w(1).plus(&w(2)))),
            Op::wsub => wide(Some(w(1).minus(&w(2)))),
            Op::wmulw => wide(Some(w(1).times(&w(2)))),
            Op::wextend => wide(Some(s(1).scaled(shift(2)))),
            Op::wround => scalar(Some(w(1).scaled(-shift(2)))),
            Op::wdiv => {
                let quotient = w(1).over(&w(2)).map(|quotient| quotient.scaled(shift(3)));
                scalar(quotient.filter(|_| is_divisible(2, true)))
            }
            Op::wsqrt => {
                let root = w(1).scaled(shift(2)).root();
                scalar(root.filter(|_| before.wide(number(1)) >= 0))
            }
            other => panic!("{other:?} is not modelled"),
        }
    }
}

/// Rows of straight-line programs.
const ROWS: [Op; 30] = [
    Op::add,
    Op::sub,
    Op::neg,
    Op::abs,
    Op::mul,
    Op::div,
    Op::min,
    Op::max,
    Op::rshift,
    Op::lshift,
    Op::scale,
    Op::vadd,
    Op::vsub,
    Op::vmul,
    Op::vscale,
    Op::vdot,
    Op::vcross,
    Op::vsplat,
    Op::vget,
    Op::wmul,
    Op::wmac,
    Op::wmsub,
    Op::wdot,
    Op::wadd,
    Op::wsub,
    Op::wmulw,
    Op::wextend,
    Op::wround,
    Op::wdiv,
    Op::wsqrt,
];

/// An instruction of a row on a few registers.
fn straight() -> impl Strategy<Value = Straight> {
    (0..ROWS.len(), prop::array::uniform4(0u8..64)).prop_map(|(row, choices)| {
        let (isa, op) = (Isa::base(), ROWS[row]);
        let operands = isa.definition(op).operands.iter().zip(choices).map(|(operand, choice)| match operand.kind {
            Kind::S => 1 + i64::from(choice % 4),
            Kind::V => i64::from(choice % 3),
            Kind::W => i64::from(choice % 3),
            Kind::Lane => i64::from(choice % 3),
            _ => i64::from(choice % 40),
        });
        (op, operands.collect())
    })
}

fn start() -> impl Strategy<Value = Registers> {
    let small = any::<i32>().prop_flat_map(|n| (0u32..31).prop_map(move |by| n >> by));
    prop::collection::vec(small, 20).prop_map(|numbers| {
        let mut registers = Registers::default();
        (1..5).for_each(|n| registers.set_scalar(n, numbers[usize::from(n)]));
        (0..3).for_each(|n| registers.set_vector(n, [0, 1, 2].map(|k| numbers[5 + 3 * usize::from(n) + k])));
        (0..3).for_each(|n| registers.set_wide(n, i64::from(numbers[14 + usize::from(n)]) << 20));
        registers
    })
}

#[test]
fn shadows_of_straight_line_programs_are_exact_rationals() {
    let (isa, config) = (Isa::base(), Config::default());
    check(1500, &(start(), prop::collection::vec(straight(), 1..14)), |(registers, steps)| {
        let program = program(|p| {
            steps.iter().for_each(|(op, operands)| {
                p.emit(*op, operands);
            });
            p.emit(Op::halt, &[]);
        });
        // Begin with the machine's numbers; the largest of all sets how far off a shadow may be
        let mut model = Model { numbers: BTreeMap::new(), largest: Exact::whole(1) };
        for (file, count) in [('s', 5), ('v', 3), ('w', 3)] {
            for (number, k) in (0..count).flat_map(|number| (0..3).map(move |k| (number, k))) {
                let start = model.get(&registers, file, number, k).magnitude();
                if model.largest.is_at_most(&start) {
                    model.largest = start;
                }
            }
        }
        let mut stepper = shadowed(&config, &isa, &program, registers);
        for step in &steps {
            // The model takes the step by the registers before it, then the machine does
            let before = stepper.state().registers.clone();
            let written = model.execute(step, &before);
            prop_assert!(stepper.step().is_some());
            for ((file, number, k), exact) in written {
                let shadow = stepper.shadow().unwrap();
                let numbers = shadow.of((file, number));
                let raw = match file {
                    's' => stepper.state().registers.scalar(number).into(),
                    'v' => stepper.state().registers.vector(number)[k].into(),
                    _ => stepper.state().registers.wide(number),
                };
                // A register without a deviation is the machine's number exactly.
                let deviation = numbers[k].and_then(|number| number.deviation.as_ref());
                let real = deviation.map_or_else(|| Exact::whole(raw), |deviation| Exact::of(&deviation.real));
                let Some(exact) = exact else {
                    prop_assert!(deviation.is_none(), "{step:?}: begins anew at the machine's number");
                    model.numbers.remove(&(file, number, k));
                    continue;
                };
                if model.largest.is_at_most(&exact.magnitude()) {
                    model.largest = exact.magnitude();
                }
                let error = real.minus(&exact).magnitude();
                prop_assert!(
                    error.is_at_most(&model.largest.scaled(-80)),
                    "{:?} {}{}.{}: {:?}",
                    step,
                    file,
                    number,
                    k,
                    deviation
                );
                model.numbers.insert((file, number, k), exact);
            }
        }
        Ok(())
    });
}

/// Every register that an instruction writes, with its shadows.
fn written<'a>(stepper: &'a Stepper, op: Op, operands: &[i64]) -> Vec<Option<&'a ShadowNumber>> {
    let row = stepper.code.isa.definition(op);
    let registers = row.operands.iter().zip(operands).filter(|(operand, _)| b"dexy".contains(&operand.letter));
    let shadow = stepper.shadow().unwrap();
    let each = registers.flat_map(|(operand, &first)| {
        let file = operand.kind.register_file().unwrap();
        (0..operand.kind.registers()).map(move |at| (file, first as u8 + at))
    });
    each.flat_map(|register| shadow.of(register)).collect()
}

#[test]
fn where_the_machine_rounds_nothing_the_shadow_is_the_machine() {
    let (isa, config) = (Isa::base(), Config::default());
    // Every row that computes, whatever its room; those that touch memory and control are copies and decisions.
    let computes = |op: &Op| ["scalar", "integer", "vector", "wide", "ray"].contains(&&*isa.definition(*op).room);
    let rows: Vec<Op> = Op::BUILT_IN.iter().copied().filter(computes).collect();
    assert!(rows.len() > 80);
    let choices = prop::array::uniform6(0u8..64);
    check(4000, &(start(), 0..rows.len(), choices), |(registers, row, choices)| {
        let op = rows[row];
        let operands: Vec<i64> = isa
            .definition(op)
            .operands
            .iter()
            .zip(choices)
            .map(|(operand, choice)| {
                let choice = i64::from(choice);
                match operand.kind {
                    Kind::S | Kind::A => 1 + choice % 4,
                    Kind::V => choice % 3,
                    Kind::V2 => choice % 2,
                    Kind::W => choice % 3,
                    Kind::Lane => choice % 3,
                    Kind::Un => choice % 32,
                    Kind::Sh => choice % 40,
                    _ => 0,
                }
            })
            .collect();
        let program = program(|p| {
            p.emit(op, &operands);
            p.emit(Op::halt, &[]);
        });
        let mut stepper = shadowed(&config, &isa, &program, registers);
        let executed = stepper.step().unwrap();
        let losses = executed.losses.quantized + executed.losses.overflowed;
        let deviating =
            written(&stepper, op, &operands).iter().flatten().filter(|number| number.deviation.is_some()).count();
        // A distance beyond the word saturates without being counted as a loss, and a division by 0 has no real quotient.
        let is_special = matches!(op, Op::rtri) || executed.losses.overflowed > 0;
        prop_assert!(losses > 0 || is_special || deviating == 0, "{op:?} {operands:?}: exact, yet a shadow differs");
        prop_assert!(losses == 0 || is_special || deviating > 0, "{op:?} {operands:?}: rounded, yet no shadow differs");
        Ok(())
    });
}

#[test]
fn shadows_go_through_memory_and_messages_and_integers_have_none() {
    let (isa, config) = (Isa::base(), Config::default());
    let program = program(|p| {
        p.constant(1, 7);
        p.constant(2, 3);
        p.emit(Op::div, &[3, 1, 2, 4]); // s3 = 37, exactly 37 1/3
        p.emit(Op::sw, &[3, 0, 16]);
        p.emit(Op::lw, &[4, 0, 16]);
        p.constant(5, 64);
        p.constant(6, 16);
        p.constant(7, 4);
        p.emit(Op::store, &[5, 6, 7]); // to global memory
        p.emit(Op::ldw, &[8, 5, 0]);
        p.emit(Op::load, &[7, 5, 7]); // and back to address 4 of the buffer
        p.emit(Op::lw, &[9, 0, 4]);
        p.emit(Op::vsplat, &[1, 9]);
        p.emit(Op::send2, &[0, 1]);
        p.emit(Op::recv2, &[3, 10]);
        p.emit(Op::vget, &[11, 3, 2]);
        p.emit(Op::or, &[12, 11, 0]); // changes no bit
        p.emit(Op::iaddi, &[13, 11, 1]); // an integer
        p.emit(Op::sb, &[0, 0, 17]);
        p.emit(Op::lw, &[14, 0, 16]); // a part of it was overwritten
        p.emit(Op::halt, &[]);
    });
    let mut stepper = shadowed(&config, &isa, &program, Registers::default());
    stepper.run_to(u64::MAX);
    let shadow = stepper.shadow().unwrap();
    let real = |n: u8| shadow.of(('s', n))[0].and_then(|number| Some(number.deviation.as_ref()?.real.to_f64()));
    for n in [3, 4, 8, 9, 11, 12] {
        assert_eq!(real(n), Some(112.0 / 3.0), "s{n}");
    }
    for n in [1, 10, 13, 14] {
        assert!(shadow.of(('s', n))[0].is_none(), "s{n} is an integer");
    }
    // Of the one rounding, all errors are made.
    let parts = shadow.of(('s', 12))[0].unwrap().deviation.as_ref().unwrap().parts;
    let parts: Vec<(u32, f64)> = parts.iter().collect();
    assert_eq!(parts.len(), 1);
    assert!((parts[0].1 + 1.0 / 3.0).abs() < 1e-6, "{parts:?}");
    assert_eq!(shadow.program.sites.sites[parts[0].0 as usize].words, [4]);
}

#[test]
fn a_shadow_is_restored_with_its_state() {
    let (isa, config) = (Isa::base(), Config::default());
    let program = program(|p| {
        p.constant(2, 3);
        p.constant(3, 1000);
        p.repeat(1, 20, |p| {
            p.emit(Op::div, &[3, 3, 2, 1]);
            p.emit(Op::sw, &[3, 1, 0]);
        });
        p.emit(Op::halt, &[]);
    });
    let real = |stepper: &Stepper| {
        let number = stepper.shadow().unwrap().of(('s', 3))[0].cloned();
        number.and_then(|number| Some(number.deviation?.real.binary()))
    };
    let mut straight = shadowed(&config, &isa, &program, Registers::default());
    straight.run_to(60);
    let mut wandering = shadowed(&config, &isa, &program, Registers::default());
    wandering.run_to(30);
    let middle = wandering.checkpoint();
    wandering.run_to(u64::MAX);
    wandering.restore(&middle);
    wandering.run_to(60);
    assert!(real(&straight).is_some());
    assert_eq!(real(&straight), real(&wandering));
    assert_eq!(straight.shadow().unwrap().ledger, wandering.shadow().unwrap().ledger);
}
