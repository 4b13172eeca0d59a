//! A surface: something that takes inputs from outside, with inputs to begin from and limits.

use crate::seen::Seen;
use crate::surfaces;

/// Form of inputs, which decides how they are changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputForm {
    /// Words and lines.
    Text,
    /// Any octets.
    Octets,
    /// Eight octets from which the surface generates what it tries.
    Number,
}

/// Something that is fuzzed.
pub struct Surface {
    /// Name on the command line.
    pub name: &'static str,
    /// Form of its inputs.
    pub form: InputForm,
    /// Most octets of an input.
    pub longest: usize,
    /// Most octets that an input may have allocated at once.
    pub memory: usize,
    /// Inputs to begin from.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Tries an input. A panic is a find.
    pub run: fn(&[u8], &mut Seen),
    /// Files of the reader, from the project's folder: of these the coverage is measured.
    pub reader: &'static [&'static str],
}

impl Surface {
    /// A surface of text, with the most octets of an input and the most that one may have allocated.
    pub const fn text(
        (longest, memory): (usize, usize),
        name: &'static str,
        seeds: fn() -> Vec<Vec<u8>>,
        run: fn(&[u8], &mut Seen),
        reader: &'static [&'static str],
    ) -> Surface {
        Surface { name, form: InputForm::Text, longest, memory, seeds, run, reader }
    }
}

/// All surfaces, the cheap ones first.
pub const SURFACES: &[Surface] = &[
    surfaces::programs::OBJECT,
    surfaces::programs::WORDS,
    surfaces::programs::HEXADECIMAL,
    surfaces::meshes::OFF,
    surfaces::meshes::STL,
    surfaces::meshes::DSC,
    surfaces::meshes::OBJ,
    surfaces::meshes::MTL,
    surfaces::meshes::PLY,
    surfaces::settings::MACHINE,
    surfaces::protections::PROTECTIONS,
    surfaces::settings::STRESS,
    surfaces::settings::ARITHMETIC,
    surfaces::settings::STUDY,
    surfaces::settings::SETTINGS,
    surfaces::results::PLAN,
    surfaces::results::PART,
    surfaces::results::INJECTIONS,
    surfaces::recordings::RECORDINGS,
    surfaces::results::TABLE,
    surfaces::results::RESULT,
    surfaces::sources::ASSEMBLER,
    surfaces::sources::EXTENSION,
    surfaces::sources::KERNEL,
    surfaces::debugger::DEBUGGER,
    surfaces::debugger::DAP,
    surfaces::arguments::ARGUMENTS,
    surfaces::engines::PROGRAM,
    surfaces::engines::FRAME,
    surfaces::scenes::SCENE,
];
