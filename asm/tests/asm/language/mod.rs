//! The language, feature by feature: small sources and the words or octets that they make.

mod macros;
mod names;

use std::collections::HashMap;

use asm::{Options, assemble, disassemble};
use isa::{Isa, Program};
use messages::Source;

fn options_with(defines: &[(&str, i64)], formats: &[(&str, i64)]) -> Options<'static> {
    let own = |pairs: &[(&str, i64)]| pairs.iter().map(|&(name, value)| (name.to_string(), value)).collect();
    Options { defines: own(defines), formats: own(formats), ..Options::default() }
}

fn program(text: &str) -> Program {
    program_with(text, &Options::default())
}

fn program_with(text: &str, options: &Options) -> Program {
    match assemble(&Source::new("t.s", text), &Isa::base(), options) {
        Ok(assembled) => assembled.program,
        Err(report) => panic!("{report}\nin\n{text}"),
    }
}

/// The instructions of a source, one a line, as the disassembler writes them.
fn code(text: &str) -> String {
    lines(&program(text))
}

fn lines(program: &Program) -> String {
    let text = disassemble(&program.words, &Isa::base());
    text.lines().map(str::trim).collect::<Vec<_>>().join("; ")
}

#[test]
fn instructions_of_each_operand_kind() {
    assert_eq!(code("add s1, s2, s3"), "add s1, s2, s3");
    assert_eq!(
        code("lw s1, 8(s2)\nlw s1, (s2)\nlw s1, s2, 8\nlw s1, -4*2(s2)"),
        "lw s1, 8(s2); lw s1, 0(s2); lw s1, 8(s2); lw s1, -8(s2)"
    );
    assert_eq!(
        code("vget s1, v2, y\nvput v1, s2, 2\nvget s1, v2, 1-1"),
        "vget s1, v2, 1; vput v1, s2, 2; vget s1, v2, 0"
    );
    assert_eq!(code("lvh v1, 6(s2), 16"), "lvh v1, 6(s2), 16");
    assert_eq!(code("wdiv s1, w1, w2, 30\nsend2 s1, v30\nbarrier"), "wdiv s1, w1, w2, 30; send2 s1, v30; barrier");
    assert_eq!(code("beq s1, s2, .+4\njump .-1\ncall s31, 0"), "L0:; beq s1, s2, .+4; jump L0; call s31, L0");
}

#[test]
fn labels_lead_forward_and_back() {
    assert_eq!(code("a: b: beqz s1, end\nj a\nend:"), "L0:; beq s1, s0, L1; jump L0; L1:");
    assert_eq!(code("1: nop\n1: j 1b\nj 1f\n1:\n1: j 1b"), "mov s0, s0; L0:; jump L0; jump L1; L1:; jump L1");
    let program = program("nop\nstart: halt\n.buffer\n.byte 1\ndata: .byte 2\n.text\nafter:");
    assert_eq!((program.symbols["start"], program.symbols["data"], program.symbols["after"]), (1, 1, 2));
    assert_eq!(program.entry, 1);
}

#[test]
fn expressions_follow_c() {
    for (text, value) in [
        // Precedence: `*` before `+` before `<<`, and `==` before `&` before `^` before `|`
        ("1 + 2 * 3", 7),
        ("(1 + 2) * 3", 9),
        ("1 << 2 + 1", 8),
        ("7 & 3 == 3", 1),
        ("1 | 2 ^ 3 & 1", 3),
        // Quotients are rounded towards 0, and remainders have the sign of the dividend.
        ("-7 / 2", -3),
        ("-7 % 2", -1),
        ("~0", -1),
        ("!5 + !0", 1),
        ("0 || 2 && 3", 1),
        // What need not be known is not computed.
        ("0 && 1 / 0", 0),
        ("1 || 1 / 0", 1),
        ("- -3", 3),
        ("min(3, max(1, 2)) + abs(-4)", 6),
        ("bits(255) * 100 + bits(0)", 800),
        ("low(0x18000)", -32768),
        ("high(-1)", 65535),
        ("'a' + '\\n'", 107),
        ("0x7fff_ffff_ffff_ffff", i64::MAX),
        ("-9223372036854775808", i64::MIN),
        ("-(1 << 62) * 2", i64::MIN),
        // Literals in a format of 30 fraction bits, and its name as that number
        ("0.5:pos + 1:pos", 3 << 29),
        ("-1.25:pos", -5 << 28),
        ("pos - 2", 28),
        ("defined(pos) + defined(nothing) * 2", 1),
        ("3 > 2 == 1", 1),
    ] {
        let options = options_with(&[], &[("pos", 30)]);
        let program = program_with(&format!(".equ value, {text}"), &options);
        assert_eq!(program.symbols["value"], value, "{text}");
    }
}

#[test]
fn constants_may_come_later_and_variables_change() {
    assert_eq!(code("movi s1, n\n.equ n, m + 1\n.equ m, 4"), "movi s1, 5");
    assert_eq!(
        code("n = 1\nmovi s1, n\n.set n, n + 1\nmovi s1, n + later\nn = 9\nlater = 10"),
        "movi s1, 1; movi s1, 12"
    );
    assert_eq!(code("n = end - 1\nmovi s1, n\nend:"), "movi s1, 0");
}

#[test]
fn structures_have_odd_offsets_and_sizes() {
    let text = "
        .struct node
        .field kind, 1
        .field left, 4
        .field corner, 3, 3
        .align 4
        .field last, sizeof(inner)
        .endstruct
        lw s1, node.left(s2)
        lea s1, sizeof(node)(s2)
        movi s1, offsetof(node.corner) + sizeof(node.corner)
        lw s1, node.last(s3)";
    let with_inner = format!(".struct inner\n.field a, 7\n.endstruct\n{text}");
    assert_eq!(code(&with_inner), "lw s1, 1(s2); lea s1, 23(s2); movi s1, 14; lw s1, 16(s3)");
}

#[test]
fn wide_numbers_are_read_as_they_are_printed() {
    let text = ".buffer\n.wide 0xfffffffffffffff9, -9223372036854775808, 0x8000000000000000, 0x10";
    let octets: Vec<u8> = [-7, i64::MIN, i64::MIN, 16].iter().flat_map(|number| number.to_le_bytes()).collect();
    assert_eq!(program_with(text, &Options::default()).buffer, octets);
    for text in [".wide 9223372036854775808", ".wide 0xfffffffffffffff9 + 1", ".word 0xfffffffffffffff9"] {
        let source = Source::new("t.s", format!(".buffer\n{text}"));
        assert!(assemble(&source, &Isa::base(), &Options::default()).is_err(), "{text}");
    }
}

#[test]
fn data_is_little_endian_at_any_octet() {
    let options = options_with(&[], &[("pos", 4)]);
    let text = "
        .buffer
        .byte 1, -1, 255
        .half 0x1234
        .word end, -2
        .wide -3
        .fixed pos, 0.5, -1, 1.03125, (1+1)
        .ascii \"a\\n\", \"b\"
        .asciz \"é\"
        .space 2, 7
        .align 4, 9
        .org 48
    end: .byte 'x'";
    let mut octets = vec![1, 255, 255, 0x34, 0x12, 48, 0, 0, 0, 254, 255, 255, 255, 253];
    octets.extend([255; 7]);
    octets.extend([8, 0, 0, 0, 240, 255, 255, 255, 17, 0, 0, 0, 2, 0, 0, 0, b'a', 10, b'b', 0xc3, 0xa9, 0, 7, 7]);
    octets.extend([9; 3]);
    octets.push(b'x');
    assert_eq!(program_with(text, &options).buffer, octets);
}

#[test]
fn words_in_the_code() {
    let program = program(
        ".word 0x12345678, end\n.align 16\nend: .org 6\n.fixed f, 1\n.format f, 2\n"
            .replace(".fixed f, 1\n.format f, 2", ".format f, 2\n.fixed f, 1")
            .as_str(),
    );
    let nop = Isa::base().find("mov").map(|op| Isa::base().encode(op, &[0, 0]).unwrap()).unwrap();
    assert_eq!(program.words, [0x12345678, 4, nop, nop, nop, nop, 4]);
}

#[test]
fn functions_and_regions_nest() {
    let text = "
        .func outer
        .macro twice
        .region inner
        nop
        .endregion
        .endm
        twice
        nop
        twice
        .endfunc
        .func other
        twice
        .endfunc
        nop";
    let program = program(text);
    let names: Vec<_> = program.regions.iter().map(|r| (r.name.as_str(), r.is_function, r.parent)).collect();
    assert_eq!(
        names,
        [("outer", true, None), ("inner", false, Some(0)), ("other", true, None), ("inner", false, Some(2))]
    );
    assert_eq!(program.region_of, [Some(1), Some(0), Some(1), Some(3), None]);
    assert_eq!(program.symbols["other"], 3);
    let lines: Vec<u32> = program.lines.iter().map(|line| line.line).collect();
    assert_eq!(lines, [5, 9, 5, 5, 15]);
}

#[test]
fn conditions_choose_lines() {
    let text = "
        .macro pick n
        .if \\n == 1
        movi s1, 1
        .elseif \\n == 2
        .ifdef nothing
        trap 1
        .else
        movi s1, 2
        .endif
        .else
        movi s1, 3
        .endif
        .endm
        pick 1
        pick 2
        pick 3
        .ifndef nothing
        movi s2, 4
        .endif
        .if 0
        .if 1
        trap 2
        .else
        trap 3
        .endif
        this is not read
        .endif";
    // No trap is left, and a line that is left out may be anything.
    assert_eq!(code(text), "movi s1, 1; movi s1, 2; movi s1, 3; movi s2, 4");
}

#[test]
fn registers_have_other_names() {
    let text = "
        .reg pointer, s5
        .func f
        .reg value, v3
        .reg x, s4
        vget x, value, x
        lw x, 4(pointer)
        lw x, (pointer)
        .endfunc
        .func g
        .reg value, s3
        mov value, pointer
        .endfunc
        .unreg pointer
        .reg pointer, w1
        wneg pointer, w2";
    assert_eq!(code(text), "vget s4, v3, 0; lw s4, 4(s5); lw s4, 0(s5); mov s3, s5; wneg w1, w2");
}

#[test]
fn constants_take_one_word_or_two() {
    assert_eq!(code("li s1, -32768\nli s1, 32767"), "movi s1, -32768; movi s1, 32767");
    assert_eq!(
        code("li s1, 0x12348765\nli s2, -40000"),
        "movi s1, -30875; movhi s1, 4660; movi s2, 25536; movhi s2, 65535"
    );
    assert_eq!(
        code("li s1, later\nlater = 1\nli s1, 0xffffffff"),
        "movi s1, 1; movhi s1, 0; movi s1, -1; movhi s1, 65535"
    );
}

#[test]
fn every_pseudo_instruction_expands() {
    use asm::pseudo::{PSEUDOS, PseudoPart};
    let isa = Isa::base();
    for pseudo in PSEUDOS {
        assert!(isa.find(pseudo.name).is_none(), "{} is a row", pseudo.name);
        assert!(pseudo.doc.ends_with('.'), "{}", pseudo.name);
        // Small numbers, large ones, some of each, and a name that is known only later: expansions differ by them.
        for numbers in [["0", "0", "0"], ["70000", "70000", "70000"], ["1", "2", "70000"], ["later", "later", "1"]] {
            let mut next = numbers.iter();
            let operands: Vec<String> = pseudo
                .operands
                .iter()
                .map(|&(letter, part)| match part {
                    PseudoPart::Number => next.next().unwrap_or(&"1").to_string(),
                    PseudoPart::Kind(kind) => {
                        // Registers by their letters: `a` is 97, so 1, and `d` is 100, so 4.
                        kind.register_file().map_or(".".into(), |file| format!("{file}{}", letter as u8 % 8))
                    }
                })
                .collect();
            let text = format!("{} {}\nlater = 5", pseudo.name, operands.join(", "));
            assert!(!program(&text).words.is_empty(), "{text}");
        }
    }
    // Three equal components are loaded once, and 0 is there as `s0`.
    assert_eq!(code("vset v1, 0, 0, 0, s9"), "vsplat v1, s0");
    assert_eq!(code("vset v1, 7, 7, 7, s9"), "movi s9, 7; vsplat v1, s9");
    assert_eq!(
        code("vset v1, 1, 2, 3, s9"),
        "movi s9, 1; vput v1, s9, 0; movi s9, 2; vput v1, s9, 1; movi s9, 3; vput v1, s9, 2"
    );
    // Comparisons without a row are those that exist, with their operands exchanged.
    assert_eq!(
        code("x: bgt s1, s2, x\nble s1, s2, x\nbgtz s1, x\nblez s1, x"),
        "L0:; blt s2, s1, L0; bge s2, s1, L0; blt s0, s1, L0; bge s0, s1, L0"
    );
}

#[test]
fn files_include_each_other_by_name() {
    let files: HashMap<&str, &str> =
        [("a/one.s", ".include \"two.s\"\nmovi s1, two"), ("a/two.s", ".equ two, 2\nmovi s2, two")].into();
    let load = |name: &str, from: &str| {
        let folder = from.rsplit_once('/').map_or("", |(folder, _)| folder);
        let path = if folder.is_empty() { name.to_string() } else { format!("{folder}/{name}") };
        files.get(&path[..]).map(|text| Source::new(&path[..], *text)).ok_or_else(|| format!("no file {path}"))
    };
    let options = Options { include: &load, ..Options::default() };
    let program = program_with(
        ".include \"a/one.s\"\nmovi s3, two\n.include \"a/two.s\"".replace("\n.include \"a/two.s\"", "").as_str(),
        &options,
    );
    assert_eq!(lines(&program), "movi s2, 2; movi s1, 2; movi s3, 2");
    let places: Vec<_> = (0..3).map(|pc| program.place(pc).unwrap()).collect();
    assert_eq!(places, ["a/two.s:2", "a/one.s:2", "t.s:2"]);
}

#[test]
fn comments_blank_lines_and_line_ends() {
    assert_eq!(
        code("\u{feff}; one\r\n\r\n  nop // two\r\nnop # three\n;; four\nnop"),
        "mov s0, s0; mov s0, s0; mov s0, s0"
    );
}

#[test]
fn defines_and_formats_come_from_outside() {
    let options = options_with(&[("mirrors", 1)], &[("pos", 20), ("dir", 30)]);
    let text = ".if mirrors\nmul s1, s2, s3, pos + dir - pos\n.endif\n.format pos, 20\n.ifndef mirrors\n.equ mirrors, 0\n.endif";
    assert_eq!(lines(&program_with(text, &options)), "mul s1, s2, s3, 30");
}

#[test]
fn names_from_outside_are_names() {
    let isa = Isa::base();
    for (name, why) in [
        ("3x", "is no name"),
        ("", "is no name"),
        (".foo", "is no name"),
        ("a b", "is no name"),
        ("a$1", "is no name"),
        ("s1", "is a register"),
        ("mov", "is an instruction"),
        ("nop", "is an instruction"),
        ("min", "is a function"),
    ] {
        assert!(asm::check_outside_name(name, &isa).is_err_and(|text| text.contains(why)), "{name}");
    }
    for name in ["WIDTH", "_x1", "pos"] {
        assert_eq!(asm::check_outside_name(name, &isa), Ok(()), "{name}");
    }
}

#[test]
fn the_examples_of_the_description_assemble() {
    let examples: Vec<&str> =
        asm::LANGUAGE.split("```asm\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect();
    assert!(examples.len() >= 5);
    for example in examples {
        assert!(!program(example).words.is_empty());
    }
}

#[test]
fn the_examples_of_the_codes_are_wrong_in_that_way() {
    let mut shown = 0;
    for code in asm::explain::CODES {
        let example: Vec<&str> = code.text.lines().filter(|line| line.starts_with("    ")).collect();
        if example.is_empty() {
            continue;
        }
        shown += 1;
        let example = example.join("\n");
        let source = Source::new("t.s", &*example);
        let is_warning = code.code.starts_with('W');
        let report = match example.contains(".extension") {
            _ if is_warning => assemble(&source, &Isa::base(), &Options::default()).expect(code.code).warnings,
            true => {
                asm::extension::load(&mut Isa::base(), &source, &|_, _| Err("no files".into())).expect_err(code.code)
            }
            false => assemble(&source, &Isa::base(), &Options::default()).expect_err(code.code),
        };
        assert!(report.0.iter().any(|message| message.code == Some(code.code)), "{}\n{report}", code.code);
    }
    assert!(shown + 1 >= asm::explain::CODES.len(), "{shown} examples");
}

#[test]
fn entries_are_labels() {
    assert_eq!(program("nop\nmain: nop\nx: nop\n.entry x").entry, 2);
    assert_eq!(program("nop\nmain: nop").entry, 1);
    assert_eq!(program("nop\nmain: nop\nstart: nop").entry, 2);
    assert_eq!(program("nop").entry, 0);
}
