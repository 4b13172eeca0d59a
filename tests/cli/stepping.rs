//! `lancer debug`: long motions back, what is printed, and what wrong commands say.

use std::time::Instant;

use super::session::Session;

/// A loop of five instructions, 15,000,000 in all.
const LOOP: &str = "        li      s1, 3000000
        .format pos, 16
        li      s2, 1:pos
1:      mul     s3, s2, s2, pos
        sw      s3, 0(s0)
        lw      s4, 0(s0)
        isubi   s1, s1, 1
        bnez    s1, 1b
        halt
";

#[test]
fn a_thousand_lines_back_are_as_quick_as_far_from_the_start_as_near_it() {
    let session = Session::new();
    session.write("loop.s", LOOP);
    session.write("there.txt", "goto 5000000\n");
    session.write("back.txt", "goto 5000000\nback-step 1000\nback-next 1000\nback 1000\nhash\n");
    session.write("fresh.txt", "goto 4997000\nhash\n");
    let timed = |script: &str| {
        let begun = Instant::now();
        (session.succeed(&format!("debug loop.s --commands {script}")), begun.elapsed())
    };
    let (_, there) = timed("there.txt");
    let (back, both) = timed("back.txt");
    let hash = |text: &str| text.lines().last().unwrap().to_owned();
    assert_eq!(hash(&back), hash(&timed("fresh.txt").0));
    // Each of the 2,001 motions took half of 32,768 instructions when checkpoints were alike far apart: seconds.
    assert!(both < 4 * there + std::time::Duration::from_millis(1500), "{there:?} there, {both:?} there and back");
}

#[test]
fn components_the_counter_and_the_step_are_printed() {
    let session = Session::new();
    session.write("loop.s", LOOP);
    session.write("script.txt", "instruction 3\nprint v1.y,v1:16,pc,step,v1.z:pos\n");
    let text = session.succeed("debug loop.s --reg v1=1:2:65536 --commands script.txt");
    for line in ["v1.y=2  0x00000002", "pc=3 (loop.s:3)  0x0003", "step=3", "v1.z=65536 (1:pos)  0x00010000"] {
        assert!(text.lines().any(|shown| shown == line), "{line} in\n{text}");
    }
    for (command, message) in [
        ("print s1.y", "has one number and no components"),
        ("print v1.w", "`w` is no component: x, y or z"),
        ("break 4 if", "a condition is missing behind `if`: write such as if s1 == 5"),
        ("x vdto s1, v1", "error: `vdto` is not an instruction"),
        ("x mul s1, s2, s3, 99", "error: 99 does not fit operand `i` of `mul`"),
    ] {
        session.write("wrong.txt", command);
        let run = session.run("debug loop.s --commands wrong.txt");
        assert!(run.code == 1 && run.messages.contains(message), "{command}: {}", run.messages);
        assert!(!run.messages.contains("error: error"), "{}", run.messages);
    }
    for command in ["render cornell --pixel -1,3", "explain-pixel cornell -1,3", "trace cornell --pixel 1,-3"] {
        session.fail(command, 2, "is negative: columns and rows count from 0");
    }
}
