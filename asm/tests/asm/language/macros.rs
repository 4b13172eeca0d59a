//! Repetitions and macros: written once and read often.

use asm::{Options, assemble};
use isa::Isa;
use messages::Source;

use super::{code, program};

#[test]
fn repetitions_count() {
    assert_eq!(code(".rept 3, i\nmovi s1, i * 2\n.endr"), "movi s1, 0; movi s1, 2; movi s1, 4");
    assert_eq!(code(".rept 2\n.rept 2, k\nmovi s1, k\n.endr\n.endr"), "movi s1, 0; movi s1, 1; movi s1, 0; movi s1, 1");
    assert_eq!(code(".irp r, s1, s2\nmovi \\r, 1\n.endr\n.rept 0\nnonsense\n.endr"), "movi s1, 1; movi s2, 1");
}

#[test]
fn macros_take_arguments_defaults_and_the_rest() {
    let text = "
        .macro load_pair first, second, from=s9, offset=4*(1+1)
        lw \\first, \\offset(\\from)
        lw \\second, \\offset+4(\\from)
        .endm
        load_pair s1, s2
        load_pair s1, s2, s3, 0
        load_pair s1, offset=16, second=s4";
    assert_eq!(code(text), "lw s1, 8(s9); lw s2, 12(s9); lw s1, 0(s3); lw s2, 4(s3); lw s1, 16(s9); lw s4, 20(s9)");
    let sum = "
        .macro all head, tail...
        movi s1, \\head
        .ifnb \\tail
        all \\tail
        .endif
        .endm
        all 1, 2, (3, 4)";
    assert!(assemble(&Source::new("t.s", sum), &Isa::base(), &Options::default()).is_err());
    assert_eq!(code(&sum.replace("(3, 4)", "min(3, 4)")), "movi s1, 1; movi s1, 2; movi s1, 3");
    let gnu = sum.replace("(3, 4)", "4").replace("head, tail...", "head:req, tail:vararg");
    assert_eq!(code(&gnu), "movi s1, 1; movi s1, 2; movi s1, 4");
}

#[test]
fn macro_arguments_are_those_of_gnu_as() {
    // The example of the manual of GNU as.
    let sum = ".macro sum from=0, to=5\n.long \\from\n.if \\to-\\from\nsum \"(\\from+1)\",\\to\n.endif\n.endm\n";
    assert_eq!(program(&format!("{sum}sum 0, 5")).words, [0, 1, 2, 3, 4, 5]);
    assert_eq!(program(&format!("{sum}sum 3 5")).words, [3, 4, 5]);
    let put = ".macro put a, b, c=7\n.byte \\a+0\n.ifnb \\b\n.byte \\b\n.endif\n.byte \\c\n.endm\n.buffer\n";
    for (call, octets) in [
        ("put", vec![0, 7]),
        ("put 1", vec![1, 7]),
        ("put , 2", vec![0, 2, 7]),
        ("put 1 2 3", vec![1, 2, 3]),
        ("put (1) 2", vec![1, 2, 7]),
        ("put 1 -2, 3", vec![255, 3, 7]),
        ("put c=9", vec![0, 9]),
        ("put \"1\", \"2\" c=\"3\"", vec![1, 2, 3]),
    ] {
        assert_eq!(program(&format!("{put}{call}")).buffer, octets, "{call}");
    }
    assert_eq!(program(".buffer\n.macro t s\n.ascii \"<\\s>\"\n.endm\nt \"a, b\"\nt c").buffer, b"<a, b><c>");
    assert_eq!(code(".macro a\nnop\n.endm\na\n.purgem a\n.macro a\nhalt\n.endm\na"), "mov s0, s0; halt");
}

#[test]
fn what_gnu_as_has_too() {
    for (text, octets) in [
        (".byte 1\n.p2align 2\n.byte 2\n.p2align 1, 9\n", vec![1, 0, 0, 0, 2, 9]),
        (".irpc d, 123\n.byte \\d\n.endr", vec![1, 2, 3]),
        (".irpc d, \"12\"\n.byte \\d\n.endr", vec![1, 2]),
        (".ascii \"a\" \"b\", \"c\"\n.asciz \"d\" \"e\"", b"abcde\0".to_vec()),
        (".ascii \"\\012\\b\"", vec![10, 8]),
        (".ifc a, a\n.byte 1\n.endif\n.ifnc a, \"b\"\n.endif", vec![1]),
        (".ifeq 1-1\n.byte 1\n.else\n.byte 2\n.endif", vec![1]),
        (".ifne 0\n.elseif 1\n.byte 3\n.endif\n.ifgt 1\n.byte 1\n.endif\n.ifle 1\n.byte 2\n.endif", vec![3, 1]),
        (".iflt -1\n.byte 1\n.endif\n.ifge 0\n.byte 2\n.endif\n.ifnotdef x\n.byte 3\n.endif", vec![1, 2, 3]),
        (".byte 1 /* 2\n3 */\n.byte /* , */ 4", vec![1, 4]),
        (".globl a, b\n.global c\n.byte 1\n.end\n.byte frobnicate (", vec![1]),
    ] {
        assert_eq!(program(&format!(".buffer\n{text}")).buffer, octets, "{text}");
    }
}

#[test]
fn local_names_of_macros_do_not_clash() {
    let text = "
        .macro spin register
        .local again, unused
        again: bnez \\register, again
        .endm
        .macro outer
        .local here
        here: spin s3
        j here
        .endm
        spin s1
        spin s2
        outer
        again: j again
        .macro number
        label\\@: j label\\@
        .endm
        number
        number";
    assert_eq!(
        code(text),
        "L0:; bne s1, s0, L0; L1:; bne s2, s0, L1; L2:; bne s3, s0, L2; jump L2; L3:; jump L3; L4:; jump L4; L5:; jump L5"
    );
}

#[test]
fn a_macro_may_be_left_early() {
    let text = "
        .macro once n
        .if \\n
        nop
        .exitm
        .endif
        halt
        .endm
        once 1
        once 0";
    assert_eq!(code(text), "mov s0, s0; halt");
}
