//! Saturation of the bus: the report's estimate of a pixel as a load, against the closed form.

use emu::machine::config::MainConfig;
use emu::machine::{Config, RunOptions, RunOutcome, Setup};
use emu::octets::Memory;
use emu::quantity::Clocks;
use isa::{Isa, Op, Program};

use super::builder::program;

/// Clocks of computing of a pixel. Report 6.1.
const COMPUTING: u64 = 203_000;
/// Clocks of its transfers. Report 6.1.
const TRANSFER: u64 = 49_600;
const SEGMENTS: i32 = 20;
const PIXELS: i32 = 1_000;

/// Twenty times 10,150 clocks of computing and a load of 1,240 octets.
fn pixel() -> Program {
    program(|p| {
        p.emit(Op::recv5, &[0, 20]).constant(3, 1_240);
        for _ in 0..SEGMENTS {
            p.repeat(1, 50, |p| {
                // 22 cross products of 9, a sum of 3, and 2 for the loop.
                for _ in 0..22 {
                    p.emit(Op::vcross, &[6, 0, 1, 30]);
                }
                p.emit(Op::vadd, &[6, 6, 1]);
            });
            p.emit(Op::load, &[0, 0, 3]);
        }
        p.emit(Op::send2, &[20, 0]).emit(Op::halt, &[]);
    })
}

/// Keeps a message ready for each core, so that no core waits for the main processor.
fn feed() -> Program {
    program(|p| {
        p.emit(Op::movi, &[1, 0]).constant(2, PIXELS).emit(Op::cores, &[3]);
        let (first, next, over) = (p.label(), p.label(), p.label());
        for _ in 0..2 {
            p.emit(Op::movi, &[5, 0]);
            let core = p.here();
            p.emit(Op::send5, &[5, 0]).emit(Op::iaddi, &[5, 5, 1]);
            p.branch(Op::bne, &[5, 3], core);
        }
        p.emit(Op::iadd, &[1, 3, 3]).emit(Op::mov, &[4, 1]);
        p.place(first);
        p.branch(Op::bge, &[1, 2], next);
        p.emit(Op::recv2, &[8, 6]).emit(Op::send5, &[6, 0]).emit(Op::iaddi, &[1, 1, 1]);
        p.branch(Op::jump, &[], first);
        p.place(next);
        p.emit(Op::recv2, &[8, 6]).emit(Op::isubi, &[4, 4, 1]);
        p.branch(Op::beq, &[4, 0], over);
        p.branch(Op::jump, &[], next);
        p.place(over);
        p.emit(Op::halt, &[]);
    })
}

fn frames(cores: &[u32]) -> Vec<RunOutcome> {
    let (isa, core, main) = (Isa::base(), pixel(), feed());
    let main_config = MainConfig { traffic: false, ..MainConfig::default() };
    let machine = |&cores: &u32| Config { cores, main: main_config.clone(), ..Config::default() };
    let machines: Vec<Config> = cores.iter().map(machine).collect();
    let setup = Setup {
        config: &machines[0],
        isa: &isa,
        core: &core,
        main: &main,
        kinds: vec![],
        options: RunOptions::default(),
    };
    let frames = emu::run_all(&setup, &machines, &Memory::new(vec![0; 1_240]), &mut |_| {});
    frames.into_iter().map(|frame| frame.unwrap_or_else(|failure| panic!("{failure}"))).collect()
}

#[test]
fn pixels_a_clock_rise_with_the_cores_until_the_bus_is_full() {
    let cores: Vec<u32> = (1..=12).chain([16]).collect();
    let frames = frames(&cores);
    for (&cores, frame) in cores.iter().zip(&frames) {
        assert_eq!((frame.item_count, frame.bus.transfers), (1_000, 20_000));
        assert_eq!(frame.bus.busy, Clocks(TRANSFER * 1_000));
        let bound = (f64::from(cores) / (COMPUTING + TRANSFER) as f64).min(1.0 / TRANSFER as f64);
        let rate = 1_000.0 / frame.clocks.0 as f64;
        assert!((rate / bound - 1.0).abs() < 0.01, "{cores} cores: {rate} for {bound}");
    }
    // One core never waits for another: 252,600 clocks a pixel, and what comes before the first and after the last one.
    let around = frames[0].clocks.0 - 1_000 * (COMPUTING + TRANSFER);
    assert!(around < 20, "{around}");
    // The report divides 203,000 by 49,600 and calls the bus full with 4.09 cores. With 4 it is 78.5 % busy, and 5 bring
    // a quarter more; (C + M) / M = 5.09 is where it is full.
    let utilisation = |cores: usize| frames[cores - 1].utilisation();
    assert!((utilisation(4) - 0.785).abs() < 0.005 && (utilisation(5) - 0.98).abs() < 0.01);
    assert!(utilisation(6) > 0.99);
}
