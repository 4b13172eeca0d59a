//! Registers that are to be shown, each in a format: `s2:pos,v1:dir`.

use std::str::FromStr;

use emu::registers::Registers;
use isa::Program;
use isa::naming::RegisterId;
use messages::did_you_mean;

use super::setting::register_of;
use super::{RegisterContents, ShownRegister};

/// Names of the components of a vector.
const COMPONENTS: [&str; 3] = ["x", "y", "z"];

/// A register or a component of one to show, and the format to show it in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShowRequest {
    register: String,
    component: Option<usize>,
    format: Option<String>,
}

/// Registers to show.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShowList(pub Vec<ShowRequest>);

impl FromStr for ShowList {
    type Err = String;

    fn from_str(text: &str) -> Result<ShowList, String> {
        text.split(',').map(str::parse).collect::<Result<_, _>>().map(ShowList)
    }
}

impl FromStr for ShowRequest {
    type Err = String;

    fn from_str(text: &str) -> Result<ShowRequest, String> {
        let (register, format) = match text.split_once(':') {
            Some((register, format)) => (register.trim(), Some(format.trim().to_owned())),
            None => (text.trim(), None),
        };
        if register.is_empty() || format.as_ref().is_some_and(String::is_empty) {
            return Err("a register is expected, such as s2, or with a format, such as s2:pos".into());
        }
        let (register, component) = match register.rsplit_once('.') {
            Some((register, name)) => {
                let component = COMPONENTS.iter().position(|known| *known == name);
                (register, Some(component.ok_or_else(|| format!("`{name}` is no component: x, y or z"))?))
            }
            None => (register, None),
        };
        Ok(ShowRequest { register: register.into(), component, format })
    }
}

/// Name and fraction bits of a format of the program, or of a number of bits.
///
/// # Errors
/// Another name, with one that is near, and more than 63 bits.
pub fn format_of<'a>(program: &'a Program, name: &'a str) -> Result<(&'a str, i32), String> {
    if let Some(format) = program.format(name) {
        return Ok(format);
    }
    if name.starts_with(|c: char| c.is_ascii_digit()) {
        let bits = name.parse().ok().filter(|bits| (0..=63).contains(bits));
        return bits.map(|bits| (name, bits)).ok_or_else(|| format!("a format has 0 to 63 fraction bits, not {name}"));
    }
    let known = || program.formats.keys().map(String::as_str);
    let hint = did_you_mean(name, known()).unwrap_or_else(|| match program.formats.is_empty() {
        true => "the program has none (`.format name, bits`); a number of fraction bits does as well".into(),
        false => format!("there are {}", known().collect::<Vec<_>>().join(", ")),
    });
    Err(format!("`{name}` is no format of the program: {hint}"))
}

impl ShowRequest {
    /// The register that is meant at the word at `pc`, if there is one.
    pub fn register(&self, program: &Program, pc: u32) -> Option<RegisterId> {
        register_of(program, &self.register, pc).ok()
    }

    /// The register as it is before the word at `pc`, in the format that was asked for, else in that which the program says it holds.
    ///
    /// # Errors
    /// A register or a format that there is not.
    pub fn shown(&self, program: &Program, registers: &Registers, pc: u32) -> Result<ShownRegister, String> {
        let register = register_of(program, &self.register, pc)?;
        let format = match &self.format {
            Some(format) => Some(format_of(program, format)?),
            None => program.format_of(register, pc),
        };
        let contents = RegisterContents::of(registers, register);
        let name = program.name_of(register, pc);
        let (Some(component), Some(raw)) = (self.component, self.component.and_then(|k| contents.component(k))) else {
            return match self.component {
                None => Ok(ShownRegister::new(register, contents, name, format)),
                Some(_) => Err(format!("`{}` has one number and no components", self.register)),
            };
        };
        let shown = ShownRegister::new(register, RegisterContents::One(raw), name, format);
        Ok(ShownRegister { register: format!("{}.{}", shown.register, COMPONENTS[component]), ..shown })
    }
}
