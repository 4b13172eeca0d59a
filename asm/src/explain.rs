//! The codes of messages, each with an explanation that a command can print.

/// A code with its explanation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DiagnosticCode {
    /// `E001` and so on; warnings begin with `W`. A code keeps its meaning for ever.
    pub code: &'static str,
    /// The subject, in a few words.
    pub title: &'static str,
    /// The explanation: what the assembler means and what to do, with an example.
    pub text: &'static str,
}

/// The code of that name, in capital or small letters.
pub fn find(code: &str) -> Option<&'static DiagnosticCode> {
    CODES.iter().find(|known| known.code.eq_ignore_ascii_case(code))
}

macro_rules! codes {
    ($($name:ident $code:literal $title:literal $text:literal;)*) => {
        $(pub(crate) const $name: &str = $code;)*

        /// All codes, in their order.
        pub const CODES: &[DiagnosticCode] = &[$(DiagnosticCode { code: $code, title: $title, text: $text }),*];
    };
}

codes! {
    INSTRUCTION "E001" "unknown instruction"
"The first word of the statement is neither an instruction, a pseudo-instruction nor a macro defined above it.
Names are written in small letters. A label needs a colon behind it.

    vdto s4, v1, v2, 16     ; there is `vdot`
    loop                    ; a label is `loop:`";
    DIRECTIVE "E002" "unknown directive"
"Words that begin with a point are directives; the manual lists them.

    .section data           ; there is no such directive: `.buffer` is where data stand";
    UNDEFINED "E003" "undefined symbol"
"The name is used but nowhere defined: no label, no `.equ` or `.set`, no field of a structure, no constant given from
outside. Capital and small letters differ.

    beqz s1, done           ; needs a line `done:` somewhere";
    DUPLICATE "E004" "defined twice"
"A name may be defined once, wherever it stands; only `.set` names a number that may change. Labels that are needed
many times can be numbers, reached by `1b` and `1f`, or `.local` names of a macro.

    .equ size, 4
    .equ size, 8            ; write `.set` for both if it is to change";
    OPERAND_COUNT "E005" "wrong number of operands"
"The instruction has more or fewer operands than were written. The message shows how it is written.

    mul s1, s2, s3          ; `mul d, a, b, i`: the shift is missing";
    OPERAND_KIND "E006" "wrong kind of operand"
"A register stands where a number belongs, a number where a register belongs, or a register of another file.

    vadd v1, v2, s3         ; all three are vectors
    add s1, s2, 4           ; write `iaddi s1, s2, 4`";
    REGISTER "E007" "no such register"
"There are scalar registers s0 to s31, vector registers v0 to v31 and wide accumulators w0 to w7. Other names of
registers come from `.reg`.

    mov s32, s1             ; the last one is s31";
    RANGE "E008" "number out of range"
"The number does not fit the place where it is used. Nothing is cut off silently: the message names the least and the
largest number that fit.

    movi s1, 40000          ; 16 bits with the sign: -32768 to 32767; `li` takes any 32 bits
    .buffer
    .byte 256               ; -128 to 255";
    REACH "E009" "target out of reach"
"A branch holds the distance to its target in a field of its word. The message names the distance and the reach.

    beq s1, s2, .+40000     ; `bne s1, s2, .+2` and then `jump .+39999` go further";
    SYNTAX "E010" "unexpected text"
"Something else was expected at this place. Operands are separated by commas; each line is one statement; comments
begin with `;`, `#` or `//`.

    add s1 s2, s3           ; a comma is missing";
    NUMBER "E011" "malformed number"
"Numbers are decimal, 0x hexadecimal, 0b binary or 0o octal, with `_` between digits as you like, of 64 bits with the
sign. A leading 0 alone is refused because it means octal to some. Fixed-point literals have at most 38 digits after
the point.

    movi s1, 012            ; write 12 or 0o12";
    TEXT "E012" "malformed text or character"
"A text stands between quotation marks on one line, a character between apostrophes. Escapes are \\n \\t \\r \\b \\f
\\\\ \\' \\\", \\x with two hexadecimal digits, and a backslash with up to three octal digits, at most \\377.

    .buffer
    .ascii \"open           ; the closing quotation mark is missing";
    CHARACTER "E013" "unexpected character"
"The character has no meaning outside of texts and comments. A backslash means something in macros only, before the
name of a parameter.

    mov \\a, s1              ; `a` is no parameter here";
    OVERFLOW "E014" "arithmetic overflow"
"Expressions are computed with 64 bits and their sign. A result that does not fit is an error; it never wraps.

    .equ big, 1 << 63       ; the largest power of two is 1 << 62";
    DIVISION "E015" "division by zero"
"The right operand of `/` or `%` is 0.

    .equ count, 0
    .equ each, 12 / count";
    LAYOUT "E016" "value needed too early"
"The number decides what the program looks like (a condition, a count, an alignment), so that it must be known when the
line is read. Labels and constants from further on are not known yet.

    .if end > 100           ; `end` is defined below
    nop
    .endif
    end:";
    CYCLE "E017" "defined by itself"
"The value of a constant depends on the constant itself, perhaps through others.

    .equ a, b + 1
    .equ b, a - 1";
    FRACTION "E018" "fraction without format"
"A number with a point means a fixed-point number, and the assembler must know its format: its fraction bits.

    .format pos, 16
    li s1, 0.5              ; write `0.5:pos`";
    FORMAT "E019" "unknown format"
"The name after the colon of a literal, or after `.fixed`, is no format. Formats come from `.format name, bits` or from
outside.

    li s1, 0.5:pso          ; with `.format pos, 16`";
    INCLUDE "E020" "file cannot be included"
"The file that `.include` names could not be read. Its name is relative to the file that includes it. Names that are
missing because of this are not reported.

    .include \"layout.s\"";
    DEPTH "E021" "too deep"
"Files that include each other, or macros and repetitions inside each other, come back to themselves or go deeper than
the limit. A macro that calls itself needs a condition that ends it.

    .macro again n
    again \\n + 1            ; never ends
    .endm
    again 1";
    UNCLOSED "E022" "not closed"
"A block is opened but not closed in the same file, macro or repetition: `.if` and `.endif`, `.macro` and `.endm`,
`.rept` and `.endr`, `.struct` and `.endstruct`, `.func` and `.endfunc`, `.region` and `.endregion`.

    .func trace             ; `.endfunc` is missing";
    UNOPENED "E023" "not opened"
"A closing directive has no opening one, or closes something else than the innermost block.

    .func trace
    .region test
    .endfunc                ; `.endregion` comes first";
    MACRO "E024" "wrong macro arguments"
"The call has too many arguments, one with the name of no parameter, or lacks one that `:req` asks for. Arguments are
separated by commas, or by blanks between operands, and may be named as in `copy to=s1`. One that is not given is empty.

    .macro copy to, from:req
    mov \\to, \\from
    .endm
    copy s1                 ; `from` is missing";
    SIZE "E025" "program too large"
"The program, with all its expansions, goes beyond a limit of the assembler: words, lines, octets of text, files. A
repetition without end looks like this, too.

    .rept 1000000000
    nop
    .endr";
    BUFFER "E026" "buffer too large"
"The initial contents of the buffer go beyond the limit of 16 MiB.

    .buffer
    .space 1 << 40";
    SECTION "E027" "wrong section"
"Instructions stand in the code (`.text`), data stand in the buffer (`.buffer`); only words of 32 bits stand in both.
In a structure stand fields only. A branch leads to code.

    .buffer
    add s1, s2, s3          ; write `.text` before";
    SAID "E028" "error of the program"
"The program says so itself, by `.error`.

    .error \"no such layout\"";
    ASSERTED "E029" "assertion failed"
"The expression of an `.assert` is 0. It is evaluated when all names are known.

    .struct node
    .field bounds, 54
    .endstruct
    .assert sizeof(node) == 55, \"a node has 55 octets\"";
    RESERVED "E030" "reserved name"
"The name means something already: a register, another name of a register, a function of expressions, or, for a macro,
an instruction.

    s1: nop                 ; `s1` is a register";
    PLACE "E031" "impossible place"
"`.align` takes a power of two, and `.org` only goes forward.

    .align 3";
    NESTING "E032" "too many parentheses"
"Parentheses, or functions of expressions, stand inside each other more than a hundred deep. Name the parts by `.equ`.";
    ENTRY "E033" "impossible entry"
"`.entry` must lead to an instruction of the program.

    .buffer
    table: .word 1
    .entry table            ; `table` is in the buffer";
    NUMERIC_LABEL "E034" "no such numeric label"
"`1b` is the last label `1:` before the line, `1f` the next one after it.

    jump 1f                 ; no `1:` follows";
    UNSET "E035" "used before it is set"
"A name that `.set` gives several values has none before the first.

    li s1, n
    .set n, 1
    .set n, 2";
    ALIAS "E036" "no such register name"
"`.unreg` ends what `.reg` began; names from `.reg` inside a function end with the function.

    .unreg count            ; `.reg count, s5` is missing";
    SHIFT "E037" "impossible shift"
"The right operand of `<<` and `>>` in an expression is 0 to 63.

    .equ mask, 1 << -1";
    ROW "E038" "malformed row of an extension"
"A file of extensions has rows as the table of instructions has them: mnemonic, operands, the 32-bit word as a bit pattern, and the ways in
which the instruction ends with what each costs. Words stand in the major opcodes custom0 to custom3.

    .extension slab
    .instr vhalf (d: V, a: V) \"custom0 ddddd aaaaa ---------------\" [Done(add 3)]   ; one bit short
    .end";
    TAKEN "E039" "taken by another instruction"
"An instruction has the name or some word already. The message shows which one.

    .extension slab
    .instr vadd (d: V, a: V) \"custom0 ddddd aaaaa ----------------\" [Done(add 3)]   ; there is a `vadd`
        vadd d, a, a
    .end";
    BODY "E040" "impossible body"
"The body of an extension instruction works on the operands of its row (by their letters), on temporaries t0, t1, ... (scalars), tv0, ...
(vectors), tw0, ... (wide accumulators) and on s0. It writes only destinations and temporaries, reads nothing that it has not written or
been given, writes every destination on every way to an outcome, and neither calls, returns, halts nor uses instructions of extensions.

    .extension slab
    .instr vhalf (d: V, a: V) \"custom0 ddddd aaaaa ----------------\" [Done(add 3)]
        vadd d, tv0, a          ; nothing has written tv0
    .end";
    WARNED "W001" "warning of the program"
"The program says so itself, by `.warning`.

    .warning \"built without shadows\"";
    MEETING "W002" "two names of one register meet"
"A register is read by a name although on every way there it was written last by another name that is known at the
same place: what the first name meant is gone, or both mean the same and one is enough. Calls are followed, too.

    .reg count, s5
    .reg total, s5
    movi count, 3
    movi total, 0
    bnez count, .+1         ; reads the 0 of `total`";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_numbered_and_explained() {
        for (place, code) in CODES.iter().filter(|code| code.code.starts_with('E')).enumerate() {
            assert_eq!(code.code, format!("E{:03}", place + 1));
            assert!(code.text.len() > 60, "{}", code.code);
        }
        assert_eq!(find("e012").map(|code| code.title), Some("malformed text or character"));
        assert_eq!(find("E999"), None);
    }
}
