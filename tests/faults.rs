//! Small inputs that users of such tools report as trouble, one row each: what the command ends with and what it says.

use std::io::Write;
use std::process::Stdio;
use std::time::{Duration, Instant};

use crate::cli::session::Session;

/// Longest time that a row may take; a test's build is ten times slower than a release.
const LONGEST: Duration = Duration::from_secs(20);

/// An input and what is right about it.
struct Fault {
    /// Files of the folder.
    files: &'static [(&'static str, &'static [u8])],
    /// Standard input.
    input: &'static [u8],
    /// Command line behind `lancer`.
    command: &'static str,
    /// Exit code.
    exit: i32,
    /// Parts of what is printed or said.
    says: &'static [&'static str],
}

const QUIET: Fault = Fault { files: &[], input: b"", command: "", exit: 0, says: &[] };

const TETRAHEDRON: &[u8] = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

const FAULTS: &[Fault] = &[
    // Names end with their line, whatever their last character is.
    Fault {
        files: &[
            ("a.obj", b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl C:\\red\\\nf 1 2 3\nf 1 3 2\n"),
            ("a.mtl", b"newmtl C:\\red\\\nKd 1 0 0\n"),
        ],
        command: "scene info a.obj",
        says: &["2 triangles", "1.00 0.00 0.00"],
        ..QUIET
    },
    // Comments and escaped blanks behind and in names.
    Fault {
        files: &[
            ("a.obj", b"mtllib a\\ b.mtl # x\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl sky\\ blue # y\nf 1 2 3\n"),
            ("a b.mtl", b"newmtl sky blue # z\nKd 0 0 1\n"),
        ],
        command: "scene info a.obj",
        says: &["1 triangle", "0.00 0.00 1.00"],
        ..QUIET
    },
    // Both opacities.
    Fault {
        files: &[
            ("a.obj", b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n"),
            ("a.mtl", b"newmtl a\nTr 1\nd 1\n"),
        ],
        command: "scene info a.obj",
        says: &["`d 1` and `Tr 1` of material `a` contradict each other", "no glass"],
        ..QUIET
    },
    // Numbers that are not used may be none.
    Fault {
        files: &[("a.obj", b"v 0 0 0 nan nan nan\nv 1 0 0 inf nan nan\nv 0 1 0\nf 1 2 3\n")],
        command: "scene info a.obj",
        says: &["1 triangle"],
        ..QUIET
    },
    Fault {
        files: &[("a.obj", b"v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")],
        command: "scene info a.obj",
        exit: 1,
        says: &["z of vertex 1 must be a finite number", "a.obj:1:7"],
        ..QUIET
    },
    // Nothing to be seen is said, with the reason.
    Fault {
        files: &[("a.stl", b"solid a\nendsolid a")],
        command: "scene info a.stl",
        says: &["a.stl: the mesh is empty"],
        ..QUIET
    },
    Fault {
        files: &[("a.obj", b"v 0 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n")],
        command: "render a.obj --size 8x6 --json --no-error",
        says: &["no camera ray meets anything", "seen edge-on: it has no width"],
        ..QUIET
    },
    Fault {
        files: &[("a.obj", TETRAHEDRON)],
        command: "render a.obj --size 8x6 --json --camera perspective --eye 0,0,9 --look 0,0,20",
        says: &["no camera ray meets anything", "between (0, 0, 0) and (1, 1, 1)"],
        ..QUIET
    },
    // Ends of text.
    Fault {
        files: &[("a.stl", b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n\x1a")],
        command: "scene info a.stl",
        says: &["1 triangle"],
        ..QUIET
    },
    Fault {
        files: &[
            ("a.dsc", b"DSC\n8 6\n1 1\n1 0 0 0 0.9 0\n0 0 9 1 1 1\n1\n0\n\x1a"),
            ("a.off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n\x1a"),
        ],
        command: "scene info a.dsc",
        says: &["1 triangle"],
        ..QUIET
    },
    Fault { files: &[("a.s", b"halt\r\n\x1a")], command: "run a.s", says: &["halted after 1 instruction"], ..QUIET },
    Fault {
        files: &[("a.s", b"start: movi s1, 7\r halt\r")],
        command: "run a.s",
        says: &["halted after 2 instructions"],
        ..QUIET
    },
    Fault {
        files: &[("a.s", b"\xff\xfeh\0a\0l\0t\0")],
        command: "assemble a.s",
        exit: 1,
        says: &["a.s is UTF-16 text, which is not read", "save it as UTF-8"],
        ..QUIET
    },
    // Compressed files.
    Fault {
        files: &[("a.obj", b"\x1f\x8b\x08\0\0\0\0\0")],
        command: "scene info a.obj",
        exit: 1,
        says: &["a.obj is compressed (gzip)", "unpack it first"],
        ..QUIET
    },
    Fault {
        files: &[("a.s", b"\x28\xb5\x2f\xfd1234")],
        command: "assemble a.s",
        exit: 1,
        says: &["a.s is compressed (zstd)"],
        ..QUIET
    },
    Fault {
        files: &[("a.hex", b"PK\x03\x04")],
        command: "run a.hex",
        exit: 1,
        says: &["a.hex is compressed (zip)"],
        ..QUIET
    },
    // Characters that nobody sees.
    Fault {
        files: &[("a.off", "OFF\n3\u{a0}1 0\n".as_bytes())],
        command: "scene info a.off",
        exit: 1,
        says: &["found `3<U+00A0>1`", "separated by spaces and tabs"],
        ..QUIET
    },
    // More faces than announced, and elements over several lines.
    Fault {
        files: &[("a.off", b"OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n")],
        command: "scene info a.off",
        says: &["1 triangle", "a.off:8:1", "not read from here on"],
        ..QUIET
    },
    Fault {
        files: &[("a.ply", b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0\n0\n1 0 0\n0\n1\n0\n3\n0 1 2\n")],
        command: "scene info a.ply",
        says: &["1 triangle"],
        ..QUIET
    },
    // Names of materials are kept, or their loss is said.
    Fault {
        files: &[
            ("a.obj", b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red brick\nf 1 2 3\n"),
            ("a.mtl", b"newmtl red brick\nKd 1 0 0\n"),
        ],
        command: "scene convert a.obj b.ply",
        says: &["the names of materials"],
        ..QUIET
    },
    // A program without an end.
    Fault {
        files: &[("a.s", b"movi s1, 1\n")],
        command: "run a.s",
        exit: 3,
        says: &["a.s:1:1", "the last word", "a program ends with `halt`"],
        ..QUIET
    },
    // Files that guard themselves, and those that do not.
    Fault {
        files: &[("a.s", b".ifndef G\n.equ G, 1\n.include \"a.s\"\nmovi s1, 1\nhalt\n.endif\n")],
        command: "run a.s",
        says: &["halted after 2 instructions"],
        ..QUIET
    },
    Fault {
        files: &[
            ("a.s", b".ifndef A\n.equ A, 1\n.include \"b.s\"\nmovi s1, b\nhalt\n.endif\n"),
            ("b.s", b".ifndef B\n.equ B, 1\n.include \"a.s\"\n.equ b, 5\n.endif\n"),
        ],
        command: "run a.s",
        says: &["halted after 2 instructions"],
        ..QUIET
    },
    Fault {
        files: &[("a.s", b".include \"a.s\"\nhalt\n")],
        command: "assemble a.s",
        exit: 1,
        says: &["E021", "`a.s` includes itself"],
        ..QUIET
    },
    // A gap in the listing.
    Fault {
        files: &[("a.s", b"nop\n.org 40000\nhalt\n")],
        command: "assemble a.s --list",
        says: &["000001  ", " x 39999"],
        ..QUIET
    },
    // What other assemblers write otherwise.
    Fault {
        files: &[("a.s", b"add $s1, s2, s3\nmovhi s1, %hi(t)\nlw s1, [s2+4]\n.include \"lib\\x.s\"\n")],
        command: "assemble a.s",
        exit: 1,
        says: &["without `$`: `s1`", "`high(t)`", "`4(s2)`", "`lib/x.s`"],
        ..QUIET
    },
    // A wide number as `run` prints it.
    Fault {
        files: &[("a.s", b"halt\n.buffer\n.wide 0xfffffffffffffff9\n")],
        command: "assemble a.s --list",
        says: &["f9 ff ff ff ff ff ff ff"],
        ..QUIET
    },
    // Short texts that ask for much.
    Fault {
        files: &[("a.s", b".rept 1000\n.rept 1000\n.rept 1000\nnop\n.endr\n.endr\n.endr\n")],
        command: "assemble a.s",
        exit: 1,
        says: &["E025", "make more than 2097152 octets of text"],
        ..QUIET
    },
    Fault {
        files: &[("a.s", b".macro m n\nm (\\n + \\n)\n.endm\nm 1\n")],
        command: "assemble a.s",
        exit: 1,
        says: &["E0"],
        ..QUIET
    },
    // Pipes.
    Fault { input: b"halt\n", command: "run -", says: &["halted after 1 instruction"], ..QUIET },
    Fault { input: b"halt\n", command: "assemble -", says: &["<standard input>: 1 word"], ..QUIET },
    Fault { input: b"hlt\n", command: "run -", exit: 1, says: &["<standard input>:1:1"], ..QUIET },
    Fault { input: TETRAHEDRON, command: "scene info -", says: &["4 triangles"], ..QUIET },
    Fault { input: TETRAHEDRON, command: "render - --size 4x3 --json --no-error", says: &["\"triangles\": 4"], ..QUIET },
    // Words in any order of addresses; numbers as they are printed.
    Fault {
        files: &[("a.hex", b"@2 d0000004 @0 18200007 18400008")],
        command: "run a.hex",
        says: &["halted after 3 instructions"],
        ..QUIET
    },
    Fault {
        files: &[("a.s", b"l: j l\n")],
        command: "run a.s --max-steps 1,000",
        exit: 5,
        says: &["1,000"],
        ..QUIET
    },
    Fault { files: &[("a.s", b"halt\n")], command: "run a.s --max-steps 10,00", exit: 2, says: &["10,00"], ..QUIET },
    Fault {
        files: &[("a.s", b"halt\n")],
        command: "run a.s --reg w0=0xfffffffffffffff9",
        says: &["-7", "fffffffffffffff9"],
        ..QUIET
    },
    // Vectors that are none.
    Fault { files: &[("a.csv", b"")], command: "arithmetic check a.csv", exit: 1, says: &["error"], ..QUIET },
    Fault {
        files: &[("a.csv", b"op,sa,wa,ia,a,sb,wb,ib,b,sc,wc,ic,c,sr,wr,ir,q,o,n,r,qf,of\n")],
        command: "arithmetic check a.csv",
        exit: 1,
        says: &["a.csv has no vectors"],
        ..QUIET
    },
    // Machines that would take a host's memory.
    Fault {
        files: &[("a.toml", b"buffer_octets = 16777216\ncores = 256\n")],
        command: "render triangle --size 4x3 --json --machine a.toml",
        exit: 1,
        says: &["`buffer_octets` is 16777216 for each of 256 cores", "a.toml:1:17"],
        ..QUIET
    },
    Fault {
        files: &[("a.toml", &[b'['; 300 << 10])],
        command: "machine a.toml",
        exit: 1,
        says: &["a.toml is larger than 256 KiB"],
        ..QUIET
    },
    Fault {
        files: &[("a.toml", &[b'['; 3 << 20])],
        command: "render cornell --settings a.toml",
        exit: 1,
        says: &["a.toml is larger than 2 MiB"],
        ..QUIET
    },
    Fault {
        files: &[("a.toml", &[b'['; 3 << 20])],
        command: "sweep a.toml",
        exit: 1,
        says: &["a.toml is larger than 2 MiB"],
        ..QUIET
    },
    Fault {
        files: &[("a.toml", &[b'['; 3 << 20])],
        command: "diff a.toml a.toml",
        exit: 1,
        says: &["a.toml is larger than 2 MiB"],
        ..QUIET
    },
    // Extensions in the text of old systems, and in other encodings.
    Fault { files: &[("a.isa", &EXTENSION_OF_OLD)], command: "extension check a.isa", says: &["twice"], ..QUIET },
    Fault {
        files: &[("a.isa", b"\xff\xfe;\0;\0")],
        command: "extension check a.isa",
        exit: 1,
        says: &["a.isa is UTF-16 text"],
        ..QUIET
    },
    Fault {
        files: &[("a.isa", b"\x1f\x8b\x08\0")],
        command: "extension check a.isa",
        exit: 1,
        says: &["a.isa is compressed (gzip)"],
        ..QUIET
    },
    // Words in hexadecimal that are piped.
    Fault { input: b"// 1 words of 32 bits\nd0000004\n", command: "disassemble -", says: &["halt"], ..QUIET },
];

/// An extension whose lines end in carriage returns alone, with a Ctrl-Z at its end.
const EXTENSION_OF_OLD: [u8; EXTENSION.len()] = {
    let (mut text, mut at) = (*EXTENSION, 0);
    while at < text.len() {
        if text[at] == b'\n' {
            text[at] = b'\r';
        }
        at += 1;
    }
    text
};

const EXTENSION: &[u8; 117] = b".extension a\n.instr twice (d: S, a: S)  \"custom0 ddddd aaaaa ----- ----- ------\"  [Done(body)]\n    add d, a, a\n.end\n\x1a";

#[test]
fn every_input_gives_what_is_right() {
    for fault in FAULTS {
        let session = Session::new();
        for (name, octets) in fault.files {
            std::fs::write(session.path(name), octets).unwrap();
        }
        let start = Instant::now();
        let mut command = session.command(fault.command);
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        // A command that does not read its input is no failure of this test.
        let _ = child.stdin.take().unwrap().write_all(fault.input);
        let output = child.wait_with_output().unwrap();
        let text = [&output.stdout[..], &output.stderr[..]].concat();
        let text = String::from_utf8(text).expect("results and messages are text");
        assert_eq!(output.status.code(), Some(fault.exit), "lancer {}\n{text}", fault.command);
        for part in fault.says {
            assert!(text.contains(part), "lancer {}: no `{part}` in\n{text}", fault.command);
        }
        assert!(start.elapsed() < LONGEST, "lancer {} took {:?}", fault.command, start.elapsed());
        let leftovers: Vec<String> = session.names().into_iter().filter(|name| name.starts_with(".lancer-")).collect();
        assert!(leftovers.is_empty(), "lancer {} leaves {leftovers:?}", fault.command);
    }
}

#[test]
fn names_of_materials_go_from_one_obj_to_another() {
    let session = Session::new();
    session
        .write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red brick\nf 1 2 3\nusemtl none\nf 1 3 2\n");
    session.write("a.mtl", "newmtl red brick\nKd 1 0 0\n");
    assert_eq!(session.run("scene convert a.obj b.obj").code, 0);
    let (mesh, library) = (session.read("b.obj"), session.read("b.mtl"));
    for (octets, names) in
        [(mesh, ["usemtl red brick", "usemtl material_1"]), (library, ["newmtl red brick", "newmtl material_1"])]
    {
        let text = String::from_utf8(octets).unwrap();
        assert!(names.iter().all(|name| text.contains(name)), "{text}");
    }
}

#[test]
fn notes_of_an_extension_are_text_in_the_page() {
    let session = Session::new();
    session.write(
        "a.isa",
        ".extension a\n\n;; <script>alert(1)</script> [x](javascript:alert(1))\n;; Twice `a`.\n\
         .instr twice (d: S, a: S)  \"custom0 ddddd aaaaa ----- ----- ------\"  [Done(body)]\n    add d, a, a\n.end\n",
    );
    let page = session.run("manual --as html --ext a.isa");
    assert_eq!(page.code, 0, "{}", page.messages);
    assert!(!page.out.contains("<script>") && page.out.contains("&lt;script&gt;"));
    assert!(!page.out.contains("href=\"javascript:"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_beyond_the_size_that_a_shell_allows_is_told_and_leaves_nothing() {
    let session = Session::new();
    let lancer = session.command("").get_program().to_owned();
    let line = "ulimit -f 8; exec \"$0\" manual -o big.md";
    let output = std::process::Command::new("sh").args(["-c", line]).arg(lancer).current_dir(session.path("")).output();
    let output = output.unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert_eq!(said.trim_end(), "error: big.md cannot be written: File too large (os error 27)");
    assert_eq!(session.names(), Vec::<String>::new());
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_where_help_is_printed() {
    let session = Session::new();
    for arguments in ["--help", "--version", "render --help"] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let output = session.command(arguments).stdout(full).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments}");
        assert!(String::from_utf8_lossy(&output.stderr).contains("standard output cannot be written"), "{arguments}");
    }
}
