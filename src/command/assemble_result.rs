//! The result of `lancer assemble` as JSON.

use std::collections::BTreeMap;
use std::path::PathBuf;

use isa::Program;
use schemars::JsonSchema;
use serde::Serialize;

use crate::result::hexadecimal;

/// Version of [`AssembledProgram`].
pub const SCHEMA: &str = "lancer-assemble-1";

/// An assembled program.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct AssembledProgram {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// Path of the source as the user gave it.
    pub file: String,
    /// All files that it was made from, the source first.
    pub sources: Vec<String>,
    /// Number of instruction words.
    pub words: usize,
    /// Octets of initial data.
    pub data_octets: usize,
    /// Word at which execution starts.
    pub entry: u32,
    /// The instruction words as unsigned numbers.
    pub code: Vec<u32>,
    /// The initial data in hexadecimal, from address 0 of the local buffer on.
    pub data: String,
    /// Labels and constants by name: labels of code in words, of data in octets.
    pub symbols: BTreeMap<String, i64>,
    /// Functions and regions in the order of the program.
    pub regions: Vec<AssembledRegion>,
    /// Files that were written.
    pub written: Vec<String>,
}

/// A function or region of a program.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct AssembledRegion {
    /// Name of the region.
    pub name: String,
    /// True of a function, which is entered by calls.
    pub is_function: bool,
    /// Name of the region around it; null for one at the outside.
    pub parent: Option<String>,
    /// Instruction words that lie in it and in no region of its own.
    pub words: usize,
}

impl AssembledProgram {
    /// The result of assembling a file.
    pub fn new(file: String, program: &Program, written: &[PathBuf]) -> AssembledProgram {
        let name = |number: u16| program.regions.get(usize::from(number)).map(|region| region.name.clone());
        let own = |number: usize| program.region_of.iter().flatten().filter(|&&at| usize::from(at) == number).count();
        let regions = program.regions.iter().enumerate().map(|(number, region)| AssembledRegion {
            name: region.name.clone(),
            is_function: region.is_function,
            parent: region.parent.and_then(name),
            words: own(number),
        });
        AssembledProgram {
            schema: SCHEMA,
            file,
            sources: program.sources.iter().map(|source| source.name.clone()).collect(),
            words: program.words.len(),
            data_octets: program.buffer.len(),
            entry: program.entry,
            code: program.words.clone(),
            data: hexadecimal(&program.buffer),
            symbols: program.symbols.clone(),
            regions: regions.collect(),
            written: written.iter().map(|path| path.display().to_string()).collect(),
        }
    }
}
