//! Files of assembled programs: objects, words, hexadecimal text.

use std::path::Path;

use isa::{Isa, Program};
use lancer::files::program::ProgramFile;

use crate::project::{files, literals, pieces};
use crate::seen::{PlantedFault, Seen, is_sample};
use crate::surface::{InputForm, Surface};

const LONGEST: usize = 2000;

/// Octets that a reader may take: hexadecimal text may ask for the largest program by one address.
const MEMORY: usize = 32 << 20;

/// Object files.
pub const OBJECT: Surface = Surface {
    name: "object",
    form: InputForm::Octets,
    longest: LONGEST,
    memory: MEMORY,
    seeds: objects,
    run: read_object,
    reader: &["asm/src/object.rs"],
};

/// Words alone, which any octets are: they are shown as text that assembles to themselves.
pub const WORDS: Surface = Surface {
    name: "words",
    form: InputForm::Octets,
    longest: 240,
    memory: MEMORY,
    seeds: words,
    run: read_words,
    reader: &["asm/src/disassembly.rs"],
};

/// Words as text.
pub const HEXADECIMAL: Surface = Surface {
    name: "hex",
    form: InputForm::Text,
    longest: LONGEST,
    memory: MEMORY,
    seeds: hexadecimal,
    run: read_hexadecimal,
    reader: &["src/files/program.rs"],
};

/// The programs of the cases that assemble, and one with everything that an object file holds.
fn programs() -> Vec<Program> {
    const WHOLE: &str = ".format f, 8\n.equ a, 3\n.func start\nmovi s1, a\n.region inner\ncall s3, next\n.endregion\nhalt\n.endfunc\n\
                         .func next\n.reg x, s4\nadd x, s1, s1\nret s3\n.endfunc\n.buffer\nlist: .fixed f, 0.5, 1.5\n.asciz \"text\"\n";
    let texts = files("tests/cases", ".s").into_iter().map(|octets| String::from_utf8_lossy(&octets).into_owned());
    let assembled =
        |text: String| asm::assemble(&messages::Source::new("a.s", text), &Isa::base(), &asm::Options::default());
    let whole = assembled(WHOLE.to_owned()).unwrap_or_else(|report| panic!("{}", report.render(false)));
    // Cases are of many kinds, errors among them.
    texts.filter_map(|text| assembled(text).ok()).chain([whole]).map(|assembled| assembled.program).collect()
}

fn objects() -> Vec<Vec<u8>> {
    programs().iter().map(asm::object::write).filter(|octets| octets.len() <= LONGEST).collect()
}

fn words() -> Vec<Vec<u8>> {
    programs().iter().map(|program| ProgramFile::Binary.encode(program)).collect()
}

fn hexadecimal() -> Vec<Vec<u8>> {
    let written = programs().iter().map(|program| ProgramFile::Hexadecimal.encode(program)).collect();
    let written = pieces(written, 200);
    written.into_iter().chain(literals("src/files/program.rs")).collect()
}

fn read_object(input: &[u8], seen: &mut Seen) {
    read_whole_object(input, seen);
    // A change breaks the checksum at the end, behind which nothing more would be read: the same with the one that holds.
    let body = &input[..input.len().saturating_sub(4)];
    let sum = crc32fast::hash(body).to_le_bytes();
    if !input.ends_with(&sum) {
        read_whole_object(&[body, &sum].concat(), seen);
    }
}

fn read_whole_object(input: &[u8], seen: &mut Seen) {
    match asm::object::read(input) {
        Err(error) => seen.text(&error.to_string()),
        Ok(program) => {
            let written = asm::object::write(&program);
            let again = asm::object::read(&written).expect("what was read can be written and read");
            assert!(again == program, "an object file is read as it was written");
            seen.count("words", program.words.len());
            seen.count("octets", program.buffer.len());
            seen.count("symbols", program.symbols.len());
            seen.count("regions", program.regions.len());
            seen.count("sources", program.sources.len());
            if is_sample(input, 64) {
                let _ = asm::disassemble_program(&program, &Isa::base());
            }
            seen.plant(PlantedFault::Panic, program.words.contains(&u32::MAX));
        }
    }
}

thread_local! {
    static BASE: Isa = Isa::base();
}

fn read_words(input: &[u8], seen: &mut Seen) {
    let program = match ProgramFile::Binary.decode(Path::new("a.bin"), input.to_vec()) {
        Err(report) => return seen.report(&report, input),
        Ok(program) => program,
    };
    BASE.with(|isa| {
        let mut numbers = 0;
        for &word in &program.words {
            let Some(instruction) = isa.decode(word) else { continue };
            numbers += 1;
            let row = isa.definition(instruction.op);
            seen.name(&row.name);
            let operands: Vec<i64> =
                row.operands.iter().map(|operand| instruction.fields.get(operand.letter)).collect();
            assert_eq!(isa.encode(instruction.op, &operands), Ok(word), "a word is encoded as it was decoded");
        }
        seen.count("instructions", numbers);
        let text = asm::disassemble(&program.words, isa);
        if is_sample(input, 32) {
            let source = messages::Source::new("a.s", text);
            let assembled = asm::assemble(&source, isa, &asm::Options::default());
            let words = assembled.unwrap_or_else(|report| panic!("{}", report.render(false))).program.words;
            assert!(words == program.words, "words are shown as text that assembles to themselves");
            let _ = asm::disassemble_program(&program, isa);
        }
        let last = program.words.last().and_then(|&word| isa.decode(word));
        seen.plant(PlantedFault::Abort, last.is_some_and(|last| &*isa.definition(last.op).name == "vcross"));
    });
}

fn read_hexadecimal(input: &[u8], seen: &mut Seen) {
    // Octets of one form under the name of another.
    for name in ["a.bin", "a.o"].map(Path::new) {
        let form = ProgramFile::of(name).expect("the ending is one of programs");
        match form.decode(name, input.to_vec()) {
            Err(report) => seen.report(&report, input),
            Ok(program) => drop(form.encode(&program)),
        }
    }
    match ProgramFile::Hexadecimal.decode(Path::new("a.hex"), input.to_vec()) {
        Err(report) => seen.report(&report, input),
        Ok(program) => {
            seen.count("words", program.words.len());
            if program.words.len() < 1000 {
                let written = ProgramFile::Hexadecimal.encode(&program);
                let again = ProgramFile::Hexadecimal.decode(Path::new("a.hex"), written);
                assert!(again.is_ok_and(|again| again.words == program.words), "words are read as they were written");
            }
            seen.plant(PlantedFault::Large, program.words.len() > 100_000);
        }
    }
}
