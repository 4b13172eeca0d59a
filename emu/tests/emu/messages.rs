//! Messages, barriers and the atomic counter between processors, and who waits for whom.

use emu::machine::mailbox::Mailboxes;
use emu::machine::{Config, RunFailure, RunOptions, RunOutcome, Setup};
use emu::octets::Memory;
use emu::quantity::Clocks;
use emu::semantics::Message;
use emu::trap::{Fault, Trap};
use isa::{Isa, Op, Program};

use super::builder::{ProgramBuilder, program};

fn result(config: &Config, core: &Program, main: &Program) -> Result<RunOutcome, Box<Trap>> {
    let isa = Isa::base();
    let setup = Setup { config, isa: &isa, core, main, kinds: vec![], options: RunOptions::default() };
    match emu::run(&setup, Memory::new(vec![0; 400]), &mut |_| {}) {
        Ok(frame) => Ok(frame),
        Err(RunFailure::Trap(trap)) => Err(trap),
        Err(failure) => panic!("{failure}"),
    }
}

fn frame(cores: u32, core: impl FnOnce(&mut ProgramBuilder), main: impl FnOnce(&mut ProgramBuilder)) -> RunOutcome {
    let config = Config { cores, ..Config::default() };
    let frame = result(&config, &program(core), &program(main)).unwrap_or_else(|trap| panic!("{trap}"));
    for used in &frame.processors {
        assert_eq!(used.busy + used.waiting + used.idle, frame.clocks);
    }
    assert_eq!(frame.asked, frame.bus.moved + frame.bypassed);
    frame
}

fn trap(cores: u32, core: impl FnOnce(&mut ProgramBuilder), main: impl FnOnce(&mut ProgramBuilder)) -> Trap {
    let config = Config { cores, step_limit: 10_000, ..Config::default() };
    *result(&config, &program(core), &program(main)).expect_err("it traps")
}

fn word(frame: &RunOutcome, index: u32) -> i32 {
    frame.memory.word(4 * index).expect("it is in the memory")
}

/// Sends five vectors, the first component being `value`, to each core.
fn send_to_all(p: &mut ProgramBuilder, value: i64) {
    p.emit(Op::movi, &[2, value]).emit(Op::vput, &[0, 2, 0]).emit(Op::movi, &[1, 0]).emit(Op::cores, &[3]);
    let next = p.here();
    p.emit(Op::send5, &[1, 0]).emit(Op::iaddi, &[1, 1, 1]);
    p.branch(Op::bne, &[1, 3], next);
}

#[test]
fn the_earliest_message_is_taken_first_then_the_lowest_senders() {
    let mut mailboxes = Mailboxes::new(4);
    let message = |component| Message::new([[component; 3]; 2]);
    assert_eq!(mailboxes.next(1), None);
    mailboxes.put(1, 3, Clocks(10), message(3));
    mailboxes.put(1, 2, Clocks(20), message(2));
    mailboxes.put(1, 0, Clocks(20), message(0));
    mailboxes.put(0, 1, Clocks(1), message(9));
    let mut taken = Vec::new();
    while let Some((arrival, sender)) = mailboxes.next(1) {
        let message = mailboxes.take(1, sender).expect("it is there");
        taken.push((arrival.0, sender, message.first()[0]));
    }
    assert_eq!(taken, [(10, 3, 3), (20, 0, 0), (20, 2, 2)]);
    assert!(mailboxes.is_full(0, 1));
}

#[test]
fn a_send_waits_until_the_mailbox_is_free() {
    // The core works 500 clocks before it takes its second message; the third must wait in the sender.
    let frame = frame(
        1,
        |p| {
            p.emit(Op::recv5, &[0, 20]);
            p.repeat(1, 250, |_| {});
            p.emit(Op::recv5, &[5, 20]).emit(Op::recv5, &[10, 20]);
            p.emit(Op::vadd, &[0, 0, 5]).emit(Op::vadd, &[0, 0, 10]).emit(Op::stv, &[0, 0, 0]).emit(Op::halt, &[]);
        },
        |p| {
            for value in [1, 20, 300] {
                send_to_all(p, value);
            }
            p.emit(Op::halt, &[]);
        },
    );
    assert_eq!(word(&frame, 0), 321);
    // Messages of 60 octets arrive at 120, 242 and, since the second is taken at 620 only, 740; between two sends the
    // main processor takes two clocks. Then the core adds for six and stores for 24.
    assert_eq!(frame.clocks, Clocks(770));
    let [core, main] = [frame.processors[0], frame.processors[1]];
    assert_eq!((core.busy, core.waiting, core.idle), (Clocks(506), Clocks(24), Clocks(120 + 120)));
    assert_eq!((main.busy, main.waiting, main.idle), (Clocks(6), Clocks(360), Clocks((620 - 244) + (770 - 742))));
    assert_eq!(frame.bus.transfers, 4);
}

#[test]
fn cores_wait_for_each_other_at_a_barrier() {
    // Core n works n * 20 clocks, writes its number, waits; then each reads its neighbour's.
    let core = |p: &mut ProgramBuilder| {
        let ready = p.label();
        p.emit(Op::recv5, &[0, 20]).emit(Op::core, &[1]).emit(Op::slli, &[2, 1, 3]).emit(Op::iaddi, &[3, 1, 10]);
        let again = p.here();
        p.branch(Op::beq, &[2, 0], ready);
        p.emit(Op::isubi, &[2, 2, 1]);
        p.branch(Op::jump, &[], again);
        p.place(ready);
        p.emit(Op::slli, &[4, 1, 2]).emit(Op::stw, &[3, 4, 0]).emit(Op::barrier, &[]);
        p.emit(Op::iaddi, &[5, 1, 1]).emit(Op::andi, &[5, 5, 3]).emit(Op::slli, &[5, 5, 2]).emit(Op::ldw, &[6, 5, 0]);
        p.emit(Op::stw, &[6, 4, 16]).emit(Op::halt, &[]);
    };
    // The main processor waits there too, or has halted.
    for waits in [true, false] {
        let frame = frame(4, core, |p| {
            send_to_all(p, 0);
            if waits {
                p.emit(Op::barrier, &[]);
            }
            p.emit(Op::halt, &[]);
        });
        assert_eq!((4..8).map(|at| word(&frame, at)).collect::<Vec<_>>(), [11, 12, 13, 10], "{waits}");
        assert!(frame.processors[0].idle > frame.processors[3].idle, "who comes first waits longest");
    }
}

#[test]
fn cores_without_work_are_not_waited_for_once_the_main_processor_is_done() {
    let frame = frame(
        4,
        |p| {
            p.emit(Op::recv5, &[0, 20]).emit(Op::barrier, &[]).emit(Op::core, &[1]).emit(Op::slli, &[2, 1, 2]);
            p.emit(Op::iaddi, &[1, 1, 1]).emit(Op::stw, &[1, 2, 0]).emit(Op::halt, &[]);
        },
        |p| {
            p.emit(Op::movi, &[1, 1]).emit(Op::send5, &[1, 0]).emit(Op::movi, &[1, 3]).emit(Op::send5, &[1, 0]);
            p.repeat(1, 500, |_| {}).emit(Op::halt, &[]);
        },
    );
    assert_eq!((0..4).map(|at| word(&frame, at)).collect::<Vec<_>>(), [0, 2, 0, 4]);
    // The main processor halts after both messages, at 240, and 500 turns of two clocks.
    assert_eq!(frame.processors[1].idle, Clocks(1240 + 8));
    assert_eq!(frame.clocks, Clocks(1240 + 1 + 2 * 8));
}

#[test]
fn a_message_beside_the_bus_overtakes_one_that_is_still_on_it() {
    let mut config = Config { cores: 2, ..Config::default() };
    config.main.traffic = false;
    let core = program(|p| {
        let receiver = p.label();
        p.emit(Op::core, &[1]);
        p.branch(Op::beq, &[1, 0], receiver);
        p.emit(Op::send5, &[0, 0]).emit(Op::recv5, &[0, 20]);
        p.place(receiver).emit(Op::recv5, &[0, 20]);
        p.repeat(2, 15, |_| {});
        p.emit(Op::recv5, &[0, 21]).emit(Op::stw, &[20, 0, 0]).emit(Op::stw, &[21, 0, 4]).emit(Op::halt, &[]);
    });
    let main = program(|p| {
        p.repeat(1, 25, |_| {}).emit(Op::send5, &[0, 0]).emit(Op::halt, &[]);
    });
    let frame = result(&config, &core, &main).unwrap_or_else(|trap| panic!("{trap}"));
    // Core 1's message is on the bus from its one comparison at 1 on to 121; the main processor's comes at 50.
    assert_eq!((word(&frame, 0), word(&frame, 1)), (2, 1));
    assert_eq!(frame.clocks, Clocks(121 + 2 * 8));
    assert_eq!(frame.bypassed.0, 60);
    let core = frame.processors[0];
    assert_eq!((core.busy, core.idle, core.waiting), (Clocks(1 + 30), Clocks(49 + 41), Clocks(16)));
}

#[test]
fn the_atomic_counter_gives_each_number_once() {
    let frame = frame(
        8,
        |p| {
            p.emit(Op::recv5, &[0, 20]).emit(Op::movi, &[2, 1]);
            p.repeat(1, 5, |p| {
                p.emit(Op::fetchadd, &[3, 0, 2]).emit(Op::slli, &[4, 3, 2]).emit(Op::stw, &[2, 4, 4]);
            });
            p.emit(Op::halt, &[]);
        },
        |p| {
            send_to_all(p, 0);
            p.emit(Op::halt, &[]);
        },
    );
    assert_eq!(word(&frame, 0), 40);
    assert!((1..=40).all(|at| word(&frame, at) == 1));
    assert_eq!(frame.bus.moved.0, 8 * (60 + 5 * (8 + 4)));
}

#[test]
fn cores_may_ask_for_their_work() {
    // Each core says that it is ready before it receives; in the end all of them wait for an answer that never comes.
    let frame = frame(
        3,
        |p| {
            p.emit(Op::cores, &[1]).emit(Op::send2, &[1, 0]).emit(Op::recv5, &[0, 20]);
            p.emit(Op::vget, &[2, 0, 0]).emit(Op::slli, &[3, 2, 2]).emit(Op::stw, &[2, 3, 0]).emit(Op::halt, &[]);
        },
        |p| {
            p.emit(Op::movi, &[1, 20]);
            let next = p.here();
            p.emit(Op::recv2, &[5, 6]).emit(Op::vput, &[0, 1, 0]).emit(Op::send5, &[6, 0]).emit(Op::isubi, &[1, 1, 1]);
            p.branch(Op::bne, &[1, 0], next);
            p.emit(Op::halt, &[]);
        },
    );
    assert!((1..=20).all(|at| word(&frame, at) == at as i32));
    assert_eq!(frame.item_count, 20);
}

#[test]
fn a_core_hands_work_to_another_one_that_has_nothing_to_do() {
    let frame = frame(
        2,
        |p| {
            let done = p.label();
            p.emit(Op::recv5, &[0, 20]).emit(Op::vget, &[1, 0, 0]).emit(Op::core, &[2]);
            p.emit(Op::slli, &[3, 1, 2]).emit(Op::stw, &[1, 3, 0]);
            p.branch(Op::beq, &[1, 0], done);
            p.emit(Op::isubi, &[1, 1, 1]).emit(Op::vput, &[0, 1, 0]);
            p.emit(Op::movi, &[4, 1]).emit(Op::isub, &[2, 4, 2]).emit(Op::send5, &[2, 0]);
            p.place(done).emit(Op::halt, &[]);
        },
        |p| {
            p.emit(Op::movi, &[1, 9]).emit(Op::vput, &[0, 1, 0]).emit(Op::send5, &[0, 0]).emit(Op::halt, &[]);
        },
    );
    assert!((0..=9).all(|at| word(&frame, at) == at as i32));
    assert_eq!((frame.processors[0].items, frame.processors[1].items), (5, 5));
}

#[test]
fn programs_that_do_nothing_end() {
    let nothing = |p: &mut ProgramBuilder| {
        p.emit(Op::halt, &[]);
    };
    let frame = frame(4, nothing, nothing);
    assert_eq!((frame.clocks, frame.item_count), (Clocks(0), 4));
}

#[test]
fn waiting_for_each_other_is_a_trap_that_names_all() {
    let found = trap(
        2,
        |p| {
            p.emit(Op::recv5, &[0, 20]).emit(Op::recv5, &[0, 20]).emit(Op::halt, &[]);
        },
        |p| {
            p.emit(Op::send5, &[0, 0]).emit(Op::recv2, &[0, 1]).emit(Op::halt, &[]);
        },
    );
    assert_eq!((found.kind, found.core), (Fault::Deadlock, 0));
    assert_eq!(found.detail, "core 0 waits for a message at test.s:2, core 2 waits for a message at test.s:2");
}

#[test]
fn a_barrier_that_one_never_reaches_is_a_deadlock() {
    let core = |p: &mut ProgramBuilder| {
        p.emit(Op::recv5, &[0, 20]).emit(Op::barrier, &[]).emit(Op::halt, &[]);
    };
    let found = trap(2, core, |p| {
        p.emit(Op::send5, &[0, 0]).emit(Op::recv2, &[0, 1]).emit(Op::halt, &[]);
    });
    assert_eq!(found.kind, Fault::Deadlock);
    assert!(found.detail.starts_with("core 0 waits at a barrier"), "{}", found.detail);
}

#[test]
fn a_message_of_the_wrong_length_or_for_nobody_is_a_trap() {
    let short = trap(
        1,
        |p| {
            p.emit(Op::recv5, &[0, 20]).emit(Op::halt, &[]);
        },
        |p| {
            p.emit(Op::send2, &[0, 0]).emit(Op::halt, &[]);
        },
    );
    assert_eq!((short.kind, short.core), (Fault::MessageSize { sent: 24, expected: 60 }, 0));
    let nobody = trap(
        1,
        |p| {
            p.emit(Op::recv5, &[0, 20]).emit(Op::halt, &[]);
        },
        |p| {
            p.emit(Op::movi, &[1, -1]).emit(Op::send2, &[1, 0]).emit(Op::halt, &[]);
        },
    );
    assert_eq!((nobody.kind, nobody.core), (Fault::NoSuchCore { number: -1, largest: 1 }, 1));
}

#[test]
fn cores_cannot_play_on_among_themselves_for_ever() {
    // Two cores pass a message to and fro while the main processor waits for one that never comes.
    let found = trap(
        2,
        |p| {
            p.emit(Op::recv5, &[0, 20]).emit(Op::core, &[1]).emit(Op::movi, &[2, 1]).emit(Op::isub, &[1, 2, 1]);
            p.emit(Op::send5, &[1, 0]).emit(Op::halt, &[]);
        },
        |p| {
            p.emit(Op::send5, &[0, 0]).emit(Op::recv2, &[0, 1]).emit(Op::halt, &[]);
        },
    );
    assert_eq!(found.kind, Fault::StepLimit(10_000));
}

#[test]
fn the_first_trap_in_time_is_the_one_that_is_told() {
    // Core 1 goes wrong after 10 clocks, core 0 after 1000, though core 0 is the first to run ahead.
    let found = trap(
        2,
        |p| {
            let late = p.label();
            p.emit(Op::core, &[1]);
            p.branch(Op::beq, &[1, 0], late);
            p.repeat(2, 5, |_| {}).emit(Op::trap, &[1]);
            p.place(late).repeat(2, 500, |_| {}).emit(Op::trap, &[0]);
        },
        |p| {
            p.emit(Op::halt, &[]);
        },
    );
    assert_eq!((found.kind, found.core), (Fault::User(1), 1));
}
