//! One injection as results keep it: where, when, which bits, and what came of it.

use emu::trap::Fault;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Class of an injection's end. Each injection has one: of several the last one that applies in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum InjectionClass {
    /// Picture and counts are those without a fault.
    Masked,
    /// The picture is the same, but instructions, clocks, operations or transfers are others.
    WrongCounts,
    /// A pixel is another one.
    WrongPixel,
    /// A program trapped.
    Trap,
    /// A program ran into a limit.
    Hang,
    /// A protection put the bits right.
    Corrected,
    /// A protection found the bits.
    Detected,
}

impl InjectionClass {
    /// All of them.
    pub const ALL: [InjectionClass; 7] = [
        InjectionClass::Masked,
        InjectionClass::WrongCounts,
        InjectionClass::WrongPixel,
        InjectionClass::Trap,
        InjectionClass::Hang,
        InjectionClass::Corrected,
        InjectionClass::Detected,
    ];

    /// Name in results.
    pub const fn name(self) -> &'static str {
        match self {
            InjectionClass::Masked => "masked",
            InjectionClass::WrongCounts => "wrong_counts",
            InjectionClass::WrongPixel => "wrong_pixel",
            InjectionClass::Trap => "trap",
            InjectionClass::Hang => "hang",
            InjectionClass::Corrected => "corrected",
            InjectionClass::Detected => "detected",
        }
    }

    /// True where there is no right picture, and nobody knows: what vulnerability counts.
    pub const fn is_harmful(self) -> bool {
        matches!(self, InjectionClass::WrongPixel | InjectionClass::Trap | InjectionClass::Hang)
    }
}

/// An injection.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct InjectionRow {
    /// Structure in which bits flip (registers, buffer, program, memory, bus, results), or what goes wrong (lost_grant, doubled_grant,
    /// stuck_arbiter, stopped_core).
    pub kind: String,
    /// Number of the injection among those of its kind, which gives it again.
    pub number: u64,
    /// Class of its end.
    pub class: InjectionClass,
    /// Work item, from 0 in the order in which they are handed out; 0 of a fault whose moment is a clock.
    pub item: u32,
    /// Number of the pixel that the work item draws, row by row; null where there is none.
    pub pixel: Option<i32>,
    /// Instructions of the work item before it; of the bus and of a doubled grant, words that were moved before; of the other grants and of a core
    /// that stopped, a clock.
    pub moment: u64,
    /// Part of the kind: scalars, vectors or accumulators; constants or work space; opcodes or operands; kinds of data; addresses; masters.
    pub structure: String,
    /// Place in words: a register, an address, a word of the program.
    pub place: String,
    /// Function of the instruction that is next, computes the result, or is flipped; null in memory and on the bus.
    pub function: Option<String>,
    /// Format of the number in a register, or field of a structure in memory; null where that is not known.
    pub format: Option<String>,
    /// Bits of that number or field that flip, 0 its lowest; a field need not begin where a word does. None where there is no format.
    pub format_bits: Vec<u32>,
    /// Bits of a word of 32 bits that flip, 0 the lowest; up to 63 in an accumulator; none where that is not what goes wrong.
    pub bits: Vec<u32>,
    /// Number that the flipped bits add to a result, of an accumulator to the whole of it; 0 elsewhere.
    pub change: i128,
    /// Pixels that are others.
    pub wrong_pixels: u64,
    /// Largest difference of a component of those, in [0, 1], in steps of 10^-12.
    pub largest_difference: f64,
    /// Fault that stopped a program; null where none did.
    pub trap: Option<String>,
    /// Core, word and function at which it did; the main processor is the number of cores. Null without a trap.
    pub trap_at: Option<String>,
    /// Limit that found a hanging program: item_steps, item_wait, main_steps, main_wait, items or machine_wait; null where none did.
    pub limit: Option<String>,
    /// Steps of the guest up to that limit; null without one.
    pub steps: Option<u64>,
    /// Work items that were run for it.
    pub items: u64,
}

/// Version of [`InjectionResult`].
pub const ROW_SCHEMA: &str = "lancer-injection-2";

/// An injection by itself.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct InjectionResult {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = ROW_SCHEMA))]
    pub schema: &'static str,
    /// Beginning of the series of random numbers.
    pub seed: u64,
    /// The injection.
    #[serde(flatten)]
    pub injection: InjectionRow,
}

impl InjectionRow {
    /// True where the picture is within 1/255 of the one without a fault, and no program stopped.
    pub fn is_within_step(&self) -> bool {
        match self.class {
            InjectionClass::WrongPixel => self.largest_difference < scenes::metrics::STEP,
            class => !class.is_harmful(),
        }
    }

    /// The flipped bits of a word of 32 bits.
    pub fn mask(&self) -> u32 {
        self.bits.iter().fold(0, |mask, bit| mask | 1 << (bit % u32::BITS))
    }

    /// The highest bit of the number or field that flips; `None` where there is no format.
    pub fn highest_bit(&self) -> Option<u32> {
        self.format_bits.iter().copied().max()
    }
}

/// Name of a fault in results.
pub fn trap_name(fault: &Fault) -> &'static str {
    match fault {
        Fault::IllegalWord(_) => "illegal_word",
        Fault::NoMeaning(_) => "no_meaning",
        Fault::OutsideProgram { .. } => "outside_program",
        Fault::Buffer { .. } => "buffer",
        Fault::Memory { .. } => "memory",
        Fault::User(_) => "user",
        Fault::MessageSize { .. } => "message_size",
        Fault::NoSuchCore { .. } => "no_such_core",
        Fault::Deadlock => "deadlock",
        Fault::StepLimit(_) => "step_limit",
        Fault::Refused(_) => "refused",
        Fault::DivisionByZero => "division_by_zero",
    }
}
