//! Faults in bodies, and jumps that must not lead into them.

use emu::registers::Registers;
use emu::trap::Fault;

use super::{isa_of, program, run_with};

const FAULTS: &str = "\
.extension faults
.instr probe (d: S, a: A)  \"custom0 ddddd aaaaa ----------------\"  [Done(local 1)]
    iaddi t0, a, 0
    lw d, 0(t0)
.end
.instr spin ()  \"custom1 --------------------------\"  [Done(add 1)]
    li t0, 1
1:  bnez t0, 1b
.end
.instr fetch (d: S, a: A)  \"custom2 ddddd aaaaa ----------------\"  [Done(body)]
    ldw t0, 0(a)
    ldw t1, 4(a)
    xor d, t0, t1
.end
";

#[test]
fn a_fault_in_a_body_names_the_instruction_and_the_line_of_the_body() {
    let (isa, _) = isa_of(FAULTS);
    let program = program("    nop\n    li s1, -1\n    probe s2, s1\n    halt", &isa);
    let trap = run_with(&program, &isa, Registers::default(), 100).trap.expect("the address is outside");
    assert!(matches!(trap.kind, Fault::Buffer { .. }));
    assert_eq!((trap.pc, trap.place.as_deref()), (2, Some("t.s:3")));
    let text = trap.diagnostic().to_string();
    assert!(text.contains("in its body at t.isa:4") && text.contains("lw d, 0(t0)"), "{text}");
    assert!(text.contains("probe s2, s1"), "{text}");
}

#[test]
fn a_body_without_end_stops_at_the_step_limit() {
    let (isa, _) = isa_of(FAULTS);
    let program = program("spin\n halt", &isa);
    let run = run_with(&program, &isa, Registers::default(), 1000);
    let trap = run.trap.expect("it goes on for ever");
    assert_eq!((trap.kind, trap.pc), (Fault::StepLimit(1000), 0));
    assert_eq!(run.state.steps, 0, "no instruction was completed");
}

#[test]
fn a_body_waits_for_the_bus_in_its_middle() {
    let (isa, _) = isa_of(FAULTS);
    let (short, long) = ("fetch s2, s1\n halt", "ldw s3, 0(s1)\n ldw s4, 4(s1)\n xor s2, s3, s4\n halt");
    let runs = [short, long].map(|text| run_with(&program(text, &isa), &isa, Registers::default(), 100));
    assert_eq!(runs[0].state.registers.scalar(2), 0x03020100 ^ 0x07060504);
    assert_eq!(runs[0].state.registers.scalar(2), runs[1].state.registers.scalar(2));
    assert_eq!((runs[0].clocks, runs[0].waiting), (runs[1].clocks, runs[1].waiting));
    assert_eq!((runs[0].tally.instructions(), runs[1].tally.instructions()), (2, 4));
}

#[test]
fn programs_do_not_get_into_bodies() {
    let (isa, _) = isa_of(FAULTS);
    // Run off the end, return and branch to where bodies are kept.
    for (text, pc) in [
        ("    spin", None),
        ("    li s1, 0\n    fetch s2, s1", Some(2)),
        ("    li s1, 7\n    ret s1\n    fetch s2, s1", Some(7)),
        ("    jump .+5\n    fetch s2, s1\n    halt", Some(5)),
        ("    beq s0, s0, .+4\n    fetch s2, s1\n    halt", Some(4)),
    ] {
        let program = program(text, &isa);
        let trap = run_with(&program, &isa, Registers::default(), 100).trap.expect("there is no halt");
        match pc {
            None => assert!(matches!(trap.kind, Fault::StepLimit(_)), "{text}: {trap}"),
            Some(pc) => {
                assert_eq!(trap.kind, Fault::OutsideProgram { words: program.words.len() as u32 }, "{text}");
                assert_eq!(trap.pc, pc, "{text}");
            }
        }
    }
}

#[test]
fn counts_go_to_the_region_and_the_line_of_the_instruction() {
    let (isa, _) = isa_of(FAULTS);
    let text = ".func outer\n.region hot\n    fetch s2, s1\n.endregion\n    halt\n.endfunc";
    let program = program(text, &isa);
    let run = run_with(&program, &isa, Registers::default(), 100);
    let profile = run.profile.expect("it was asked for");
    let hot = profile.regions.iter().find(|region| region.name == "hot").unwrap();
    assert_eq!((hot.calls, hot.instructions, hot.inclusive[isa::Class::Mem]), (1, 1, 2));
    assert_eq!(profile.outside_instructions, 0);
    let code = emu::code::Code::new(&program, &isa, Default::default());
    let lines = run.tally.lines(&code);
    assert_eq!(lines.values().map(|line| line.instructions).collect::<Vec<_>>(), [1, 1]);
}

#[test]
fn more_bodies_than_fit_are_refused() {
    let steps = "    iaddi t0, t0, 1\n".repeat(1000);
    let text = format!(
        ".extension long\n.instr long (d: S) \"custom0 ddddd ---------------------\" [Done(body)]\n    li t0, 0\n{steps}    mov d, t0\n.end"
    );
    let (isa, _) = isa_of(&text);
    let program = program(".rept 300\n    long s1\n.endr\n    halt", &isa);
    let config = emu::machine::Config::default();
    let one_core = emu::machine::one_core::OneCore::new(&config, &isa, &program);
    let report = emu::machine::one_core::run(&one_core, emu::octets::Memory::new(vec![0; 16])).expect_err("too many");
    assert!(report.to_string().contains("more than 262144 instructions"), "{report}");
}
