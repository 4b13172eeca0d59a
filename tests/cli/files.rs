//! Files: whole or not at all, and where they cannot be, a message before any work.

use super::session::Session;

const TINY: &str = "render triangle --size 6x4";

#[test]
fn a_missing_folder_is_an_error_with_a_hint_before_any_work() {
    let session = Session::new();
    // The mere kd tree of this scene would take minutes.
    session.fail("render terrain --size 2000x2000 -o no/such/a.png", 1, "mkdir -p no/such");
    session.fail(&format!("{TINY} -o a.png --heat no/b.png"), 1, "there is no folder no for no/b.png");
    session.fail("scene generate triangle -o no/such", 1, "mkdir -p no");
    assert!(session.names().is_empty());
    session.succeed("scene generate triangle -o new");
    session.fail("scene generate triangle -o new/triangle.off", 1, "`-o` names the folder");
    assert!(session.path("new/triangle.dsc").is_file());
}

#[test]
fn names_of_results_are_checked_first() {
    let session = Session::new();
    session.fail(&format!("{TINY} -o a.jpg"), 2, ".png, .ppm, .pfm");
    session.fail(&format!("{TINY} -o a"), 2, ".png, .ppm, .pfm");
    session.fail(&format!("{TINY} -o a.png --heat a.png"), 2, "a.png would be written twice");
    session.fail(&format!("{TINY} --error e.png --no-error"), 2, "cannot be used with");
    std::fs::create_dir(session.path("b.png")).unwrap();
    session.fail(&format!("{TINY} -o b.png"), 1, "b.png is a folder");
    assert_eq!(session.names(), ["b.png"]);
}

#[cfg(unix)]
#[test]
fn what_is_read_is_never_overwritten_however_it_is_spelt() {
    let session = Session::new();
    session.write("a.s", "nop\n.include \"b.inc\"\n");
    session.write("b.inc", "halt\n");
    std::os::unix::fs::symlink(session.path("a.s"), session.path("link")).unwrap();
    std::fs::create_dir(session.path("d")).unwrap();
    let absolute = session.path("a.s").display().to_string();
    for option in ["--list=./a.s", "--map=d/../a.s", "--data=link", "--list=b.inc", "--map=./b.inc"] {
        session.fail(&format!("assemble a.s {option}"), 2, "is read, and would be overwritten");
    }
    session.fail(&format!("assemble a.s --list={absolute}"), 2, "is read, and would be overwritten");
    session.fail("assemble a.s -o n.o --map=./n.o", 2, "./n.o would be written twice");
    session.succeed("assemble a.s -o n.o");
    let object = session.read("n.o");
    session.fail("disassemble n.o -o ./n.o", 2, "is read, and would be overwritten");
    session.succeed("scene generate triangle --size 6x4");
    session.fail("render triangle.off -o a.png --heat ./a.png", 2, "would be written twice");
    let mesh = session.read("triangle.off");
    session.write("t.png", &String::from_utf8(mesh.clone()).unwrap());
    session.fail("render t.png", 2, "t.png is read, and would be overwritten");
    assert_eq!((session.read("t.png"), session.read("n.o")), (mesh, object));
    assert_eq!(session.read("a.s"), b"nop\n.include \"b.inc\"\n");
}

#[test]
fn a_definition_has_a_name() {
    let session = Session::new();
    session.write("a.s", "nop\n");
    for (name, why) in
        [("3x", "is no name"), ("s1", "is a register"), ("mov", "is an instruction"), (".foo", "is no name")]
    {
        session.fail(&format!("assemble a.s -D {name}=4"), 2, why);
        session.fail(&format!("assemble a.s --format {name}=4"), 2, why);
    }
    session.succeed("assemble a.s -D x3=4 --format pos=16");
}

#[test]
fn an_old_file_survives_a_command_that_fails() {
    let session = Session::new();
    session.write("a.png", "old");
    session.write("trap.s", ".func triangle\n    trap 1\n.endfunc\n");
    session.fail(&format!("{TINY} -o a.png --kernel triangle=trap.s"), 3, "trap 1");
    assert_eq!(session.read("a.png"), b"old");
    session.succeed(&format!("{TINY} -o a.png"));
    assert!(session.read("a.png").starts_with(b"\x89PNG"));
    assert_eq!(session.names(), ["a.png", "trap.s"], "nothing is left beside it");
}

#[test]
fn inputs_that_are_not_there_are_named() {
    let session = Session::new();
    session.fail("render no/such.dsc", 1, "there is no file no/such.dsc");
    session.fail("render cornel", 1, "did you mean `cornell`?");
    session.fail("run none.s", 1, "there is no file none.s");
    session.fail("disassemble .", 1, "is a folder");
    session.fail(&format!("{TINY} --kernel triangle=none.s"), 1, "there is no file none.s");
    session.fail(&format!("{TINY} --machine none.toml"), 1, "there is no file none.toml");
    session.fail(&format!("{TINY} --machine raport"), 1, "did you mean `report`?");
}

/// All files of a folder of the repository.
fn files(folder: &str) -> Vec<std::path::PathBuf> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut paths: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

#[test]
fn every_bad_file_ends_with_1_a_message_and_nothing_written() {
    let session = Session::new();
    let is_library = |path: &std::path::PathBuf| path.extension().is_some_and(|extension| extension == "mtl");
    let mut bad = 0;
    for kind in ["dsc", "off", "obj", "ply", "stl"] {
        for path in files(&format!("scenes/tests/files/{kind}_bad")).iter().filter(|path| !is_library(path)) {
            let mut command = session.command("scene convert");
            let output = command.arg(path).args(["out.obj", "--dsc"]).output().unwrap();
            let said = String::from_utf8(output.stderr).unwrap();
            assert_eq!((output.status.code(), output.stdout.len()), (Some(1), 0), "{}: {said}", path.display());
            assert!(said.contains("error: "), "{}: {said}", path.display());
            bad += 1;
        }
    }
    for path in files("asm/tests/asm/errors") {
        let mut command = session.command("assemble -o out.o --data out.dat --map=out.map");
        let output = command.arg(&path).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), output.stdout.len()), (Some(1), 0), "{}: {said}", path.display());
        assert!(said.contains("error[E"), "{}: {said}", path.display());
        bad += 1;
    }
    assert!(bad > 200 && session.names().is_empty(), "{bad} {:?}", session.names());
}

#[test]
fn files_that_are_too_large_are_refused_before_they_are_read() {
    let session = Session::new();
    for (name, arguments, limit) in [
        ("a.off", "scene info a.off", "a.off is larger than 256 MiB"),
        ("a.dsc", "render a.dsc -o a.png", "a.dsc is larger than 256 MiB"),
        ("a.s", "assemble a.s", "a.s is larger than 64 MiB"),
        ("a.o", "run a.o", "a.o is larger than 64 MiB"),
    ] {
        // A file of nothing but a length.
        std::fs::File::create(session.path(name)).unwrap().set_len(1 << 40).unwrap();
        session.fail(arguments, 1, limit);
    }
}
