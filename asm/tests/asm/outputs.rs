//! Outputs of an assembled program: listing, map, object file.

use std::collections::HashMap;
use std::sync::Arc;

use asm::object::{ObjectError, read, write};
use asm::{Attempt, Options, attempt, listing, symbol_map};
use isa::{Isa, Program};
use messages::Source;
use proptest::prelude::*;
use testing::check;

const PROGRAM: &str = "; adds up the octets of a table
        .include \"layout.s\"
        .equ    last, end - table
        .macro  step by, to=s1
        .local  skip
        beqz    \\to, skip
        iaddi   \\to, \\to, \\by     ; \\by on
skip:
        .endm

        .func   total
        .reg    sum, s4
        li      s1, 0x12345678
loop:   lbu     s2, table(s1)
        iadd    sum, sum, s2
        .region check
        step    -1
        .endregion
        .rept   2, i
        step    i + 1, s3
        .endr
        bnez    s1, loop
        ret     s31
        .endfunc

        .if     0
        this is not read
        .endif

        .buffer
table:  .byte   1, 2, 3
        .asciz  \"a longer text than eight\"
        .space  100, 7
end:
";

const LAYOUT: &str = "        .struct node\n        .field  left, 4\n        .field  flags, 1\n        .endstruct\n";

fn tried(text: &str) -> Attempt {
    let files: HashMap<&str, &str> = [("layout.s", LAYOUT)].into();
    let include = |name: &str, _: &str| -> Result<Arc<Source>, String> {
        files.get(name).map(|text| Source::new(name, *text)).ok_or("there is no such file".into())
    };
    let options = Options { include: &include, defines: vec![("bounces".into(), 5)], ..Options::default() };
    attempt(&Source::new("total.s", text), &Isa::base(), &options)
}

#[test]
fn a_program_comes_back_from_its_text_with_data_names_and_entry() {
    let text = "nop\n.func L0\nadd s1, s2, s3\nret s31\n.endfunc\n.func start\ncall s31, L0\n1: beqz s1, 1b\nhalt\n.endfunc\n\
                .func other\nhalt\n.endfunc\n.entry other\n.buffer\n.byte 1, 2\n.space 20, 7\n";
    let assembled = |text: &str| {
        let source = Source::new("t.s", text);
        asm::assemble(&source, &Isa::base(), &Options::default()).unwrap().program
    };
    let program = assembled(text);
    let shown = asm::disassemble_program(&program, &Isa::base());
    for line in [
        "    .entry other\n",
        "L0:\n    add s1, s2, s3",
        "start:\n    call s31, L0",
        "L1:\n    beq s1, s0, L1",
        "    .buffer\n    .byte 0x01, 0x02, 0x07",
    ] {
        assert!(shown.contains(line), "{line}\n{shown}");
    }
    let again = assembled(&shown);
    assert_eq!((again.words, again.buffer, again.entry), (program.words, program.buffer, program.entry));
}

#[test]
fn the_listing_shows_lines_words_and_expansions() {
    insta::assert_snapshot!(listing(&tried(PROGRAM)));
}

#[test]
fn the_listing_shows_errors_where_they_are() {
    let wrong = PROGRAM.replace("iadd    sum", "iad     sum").replace("bnez    s1, loop", "bnez    s1, lop");
    insta::assert_snapshot!(listing(&tried(&wrong)));
}

#[test]
fn the_map_shows_names_by_address() {
    insta::assert_snapshot!(symbol_map(&tried(PROGRAM).finish().unwrap()));
}

#[test]
fn hex_has_a_word_a_line() {
    insta::assert_snapshot!(asm::hex::words(&tried("li s1, 0x12345678\nhalt").program.words));
}

#[test]
fn object_files_hold_the_whole_program() {
    for program in [tried(PROGRAM).program, Program::default(), tried("halt").program] {
        assert_eq!(read(&write(&program)), Ok(program));
    }
}

/// A program with names and formats of registers, outside and inside of a function.
const NAMED: &str = "        .format pos, 16
        .format dir, 30
        .struct node
        .field  left, 4
        .space  2
        .field  flags, 1
        .endstruct
        .reg    edge, s2
        .holds  edge, pos
        movi    s1, 1
        .func   f
        .reg    way, v1
        .holds  way, dir
        .holds  s2, dir
        vmov    way, v2
        .holds  s2
        mov     edge, s1
        ret     s31
        .endfunc
        .holds  s3, pos
        halt
";

#[test]
fn names_and_formats_of_registers_reach_the_object_file() {
    let program = tried(NAMED).finish().unwrap().program;
    let back = read(&write(&program)).unwrap();
    assert_eq!(back, program);
    let format = |register, pc| back.format_of(register, pc).map(|(name, bits)| format!("{name} {bits}"));
    let all = |register| (0..5).map(|pc| format(register, pc).unwrap_or_default()).collect::<Vec<_>>();
    assert_eq!(all(('s', 2)), ["pos 16", "dir 30", "", "", "pos 16"]);
    assert_eq!(all(('v', 1)), ["", "dir 30", "dir 30", "dir 30", ""]);
    assert_eq!(all(('s', 3)), ["", "", "", "", "pos 16"]);
    assert_eq!(
        (0..5).map(|pc| back.name_of(('v', 1), pc)).collect::<Vec<_>>(),
        [None, Some("way"), Some("way"), Some("way"), None]
    );
    assert_eq!((back.register_named("edge", 0), back.register_named("way", 99)), (Some(('s', 2)), Some(('v', 1))));
    let node = back.record("node").unwrap();
    let fields: Vec<_> = node.fields.iter().map(|field| (field.name.as_str(), field.offset, field.octets)).collect();
    assert_eq!((node.octets, fields), (7, vec![("left", 0, 4), ("flags", 6, 1)]));
    let text = listing(&tried(NAMED));
    assert!(text.contains("  s2: pos, 16") && text.contains("  s2: no format"), "{text}");
    assert!(text.lines().any(|line| line.contains("v1: dir, 30") && line.ends_with(".holds  way, dir")), "{text}");
}

#[test]
fn object_files_of_version_1_are_read_without_names_and_formats() {
    let program = tried("nop\n.func f\nhalt\n.endfunc").program;
    assert!(program.formats.is_empty() && program.register_names.is_empty());
    // Version 1 ends where four empty lists would follow, and version 2 behind them; then come the calls and one more empty list.
    let new = write(&program);
    let behind = 4 + 6 * program.words.len() + 4;
    for (version, missing) in [(1, 16 + behind), (2, behind)] {
        let mut old = new[..new.len() - 4 - missing].to_vec();
        old[8] = version;
        old.extend(crc32fast::hash(&old).to_le_bytes());
        assert_eq!(read(&old), Ok(Program { call_lines: Vec::new(), ..program.clone() }));
    }
}

#[test]
fn words_know_their_macro_calls_and_functions_what_they_compute() {
    let text = "\
        .macro  inner
        nop
        .endm
        .macro  outer
        .rept   2
        inner
        .endr
        .endm
        nop
        .func   root
        .computes wsqrt s2, w1, 1 + 1
        outer
        ret     s31
        .endfunc
        .rept   1
        outer
        .endr
";
    let program = tried(text).finish().unwrap().program;
    let back = read(&write(&program)).unwrap();
    assert_eq!(back, program);
    // The words that macros made are of the lines that called the outermost macro; a repetition is no macro.
    let lines: Vec<_> =
        (0..6).map(|pc| (program.lines[pc].line, program.call_line(pc as u32).map(|l| l.line))).collect();
    assert_eq!(lines, [(9, None), (2, Some(12)), (2, Some(12)), (13, None), (2, Some(16)), (2, Some(16))]);
    let [computed] = &back.computed[..] else { panic!("{:?}", back.computed) };
    assert_eq!((computed.words.clone(), computed.line.line), (1..4, 11));
    assert_eq!(back.line_text(computed.line).map(str::trim), Some(".computes wsqrt s2, w1, 1 + 1"));
    let word = tried("wsqrt s2, w1, 2").finish().unwrap().program.words[0];
    assert_eq!(computed.word, word);
    for (text, message) in [
        (".computes add s1, s2, s3", "outside of functions"),
        (".func f\n.computes lw s1, 0(s2)\nnop\n.endfunc", "from registers alone"),
        (".func f\n.computes sw s1, 0(s2)\nnop\n.endfunc", "from registers alone"),
        (".func f\n.computes vdto s1, v2, v3, 1\nnop\n.endfunc", "`vdto` is not an instruction"),
        (".func f\n.computes add s1, s2\nnop\n.endfunc", "takes 3 operands"),
        (".func f\n.computes mul s1, s2, s3, 64\nnop\n.endfunc", "does not fit"),
    ] {
        let report = tried(text).finish().unwrap_err().to_string();
        assert!(report.contains(message), "{text}: {report}");
    }
}

#[test]
fn damaged_object_files_are_refused() {
    let file = write(&tried(PROGRAM).program);
    for end in 0..file.len() {
        assert!(read(&file[..end]).is_err(), "cut off at {end}");
    }
    for at in 0..file.len() {
        for bit in 0..8 {
            let mut damaged = file.clone();
            damaged[at] ^= 1 << bit;
            assert!(read(&damaged).is_err(), "octet {at}, bit {bit}");
        }
    }
    assert_eq!(read(b"no"), Err(ObjectError::Magic));
    assert_eq!(read(b"lancer\x1a\n"), Err(ObjectError::Truncated));
    assert_eq!(read(b"lancer\x1a\n\x04\x00"), Err(ObjectError::Version(4)));
    assert_eq!(read(b"lancer\x1a\n\x00\x00"), Err(ObjectError::Version(0)));
    let mut longer = file.clone();
    longer.push(0);
    assert_eq!(read(&longer), Err(ObjectError::Checksum));
}

#[test]
fn octets_with_a_right_checksum_are_read_or_refused() {
    let file = write(&tried(&format!("{PROGRAM}{NAMED}")).program);
    let length = file.len();
    let changes = proptest::collection::vec((12..length - 4, prop_oneof![any::<u8>(), Just(0), Just(255)]), 1..4);
    check(5_000, &(changes, any::<bool>()), |(changes, is_cut)| {
        let mut file = file.clone();
        for &(at, octet) in &changes {
            file[at] = octet;
        }
        let end = if is_cut { changes[0].0.max(12) } else { file.len() - 4 };
        file.truncate(end);
        file.extend(crc32fast::hash(&file).to_le_bytes());
        if let Ok(program) = read(&file) {
            prop_assert_eq!(write(&program), file);
        }
        Ok(())
    });
    check(2_000, &proptest::collection::vec(any::<u8>(), 0..80), |octets| {
        let mut file = b"lancer\x1a\n\x03\x00".to_vec();
        file.extend(octets);
        file.extend(crc32fast::hash(&file).to_le_bytes());
        let _ = read(&file);
        Ok(())
    });
}

#[test]
fn the_page_of_formats_has_the_parts_of_the_object_file() {
    let (page, code) = (include_str!("../../../docs/formats.md"), include_str!("../../src/object.rs"));
    let rows: Vec<&str> = code.lines().filter_map(|line| line.strip_prefix("//! |")).collect();
    assert_eq!(rows.len(), 17);
    for row in rows {
        assert!(page.lines().any(|line| line.strip_prefix('|') == Some(row)), "docs/formats.md lacks |{row}");
    }
    assert!(page.contains(&format!("Version {} is written; all from 1 on are read.", asm::object::VERSION)));
}
