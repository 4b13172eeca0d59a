//! Standard output, standard error, and readers that go away.

use std::process::Stdio;

use super::session::Session;

#[test]
fn results_and_messages_have_no_colours_where_no_terminal_shows_them() {
    let session = Session::new();
    session.write("wrong.s", "    vdto s4, v1, v2\n");
    for arguments in
        ["assemble wrong.s", "render triangle --size 4x4", "render cornel", "--help", "machine", "nonsense"]
    {
        let run = session.run(arguments);
        assert!(!run.out.contains('\u{1b}') && !run.messages.contains('\u{1b}'), "{arguments}");
        let output = session.command(arguments).env("NO_COLOR", "1").output().unwrap();
        assert_eq!((output.stdout, output.stderr), (run.out.into_bytes(), run.messages.into_bytes()), "{arguments}");
    }
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let session = Session::new();
    for arguments in ["completions bash", "machine", "render triangle --size 4x4 --json", "--help"] {
        let mut child = session.command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{arguments}");
        assert_eq!(output.status.code(), Some(0), "{arguments}");
    }
}

#[test]
fn wrong_command_lines_end_with_2() {
    let session = Session::new();
    for (arguments, message) in [
        ("rendr cornell", "render"),
        ("render", "<SCENE>"),
        ("render cornell --size 320", "such as 320x240"),
        ("render cornell --size 0x4", "1 to 16384"),
        ("render cornell --word 33", "8..=32"),
        ("render cornell --word 7", "8..=32"),
        ("render cornell --cores 0", "1..=256"),
        ("render cornell --rounding UP", "RND"),
        ("render cornell --format dri=3", "did you mean `dir`?"),
        ("render cornell --kernel trangle=a.s", "did you mean `triangle`?"),
        ("render cornell --kernel triangle", "a function, `=` and a file"),
        ("render cornell --profile vektor", "vector"),
        ("render cornell --layout width", "wide"),
        ("render cornell --eye 1,2", "3 numbers"),
        ("render cornell --eye 1,2,inf", "not finite"),
        ("render cornell --eye 1,2,3 --camera orthographic", "has no meaning for an orthographic camera"),
        ("render cornell --fov 180", "between 0 and 180"),
        ("render cornell --shift 0.1", "2 numbers"),
        ("render cornell --ambient -1", "at least 0"),
        ("render cornell --background 0,0,2", "0 to 1"),
        ("render cornell --size 4x4 --pixel 4,0", "outside a picture of 4 x 4"),
        ("render cornell --size 4x4 --crop 1,1,4,1", "outside a picture of 4 x 4"),
        ("render cornell --crop 1,1,0,1", "leaves no pixel"),
        ("render cornell --pixel 1,1 --crop 1,1,1,1", "cannot be used with"),
        ("render cornell --bounces 31", "0..=30"),
        ("render cornell --kd-depth 41", "from 0 to 40 or `auto`"),
        ("render cornell --no-skip anyhit", "possible values: features"),
        ("render cornell --interpolate=2", "0 to 1"),
        ("skips cornell --no-skip all", "one by one"),
        ("render cornell --weight-cutoff 1.5", "0 to 1"),
        ("run a.s --reg s0=1", "always zero"),
        ("run a.s --mem 5", "an address, `=` and a file"),
        ("run a.s --dump reg", "ADDRESS:OCTETS"),
        ("run a.s --max-steps 0", "1.."),
        ("assemble a.s -D X", "a name, `=` and a value"),
        ("assemble a.s -D X=1.5", "no whole number"),
        ("assemble a.s -o a.elf", "none of .o, .bin and .hex"),
        ("scene convert cornell a.3ds", "choose a format with `--to`"),
        ("scene convert cornell a --to 3ds", "possible values: dsc, off, obj, ply, stl"),
        ("scene convert cornell a.mtl --to obj", "a.mtl would be written twice"),
        ("scene convert cornell a.dsc --to obj --dsc", "a.dsc would be written twice"),
        ("schema lancer-scene-0", "possible values"),
        ("scene generate house", "possible values"),
        ("scene", "Usage"),
        ("completions klingon", "possible values"),
        ("--size 4", "such as 320x240"),
    ] {
        let run = session.run(arguments);
        assert_eq!((run.code, run.out.as_str()), (2, ""), "{arguments}: {}", run.messages);
        assert!(run.messages.contains(message), "{arguments}: {}", run.messages);
    }
    assert!(session.names().is_empty());
    // A name may be one that the program gives to a register, so the program is read first.
    session.write("a.s", "    halt\n");
    let run = session.run("run a.s --reg x=1");
    assert_eq!((run.code, run.out.as_str()), (2, ""), "{}", run.messages);
    assert!(run.messages.contains("`x` is no register"), "{}", run.messages);
}
