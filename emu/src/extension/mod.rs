//! Meanings of extension instructions in Rust: for what assembly cannot say, such as state, noise, or a model that the host has. How
//! bodies in assembly are executed is not said here; [`crate::conformance`] holds a meaning against the body beside it.
//!
//! ```
//! use emu::extension::{Call, Ending, Meaning, attach};
//! use emu::trap::Fault;
//!
//! /// Random bits: a shift register with feedback, the same sequence in each work item.
//! #[derive(Clone, Debug)]
//! struct Noise(u32);
//!
//! impl Meaning for Noise {
//!     fn execute(&mut self, call: &mut Call) -> Result<Ending, Fault> {
//!         self.0 = self.0 >> 1 ^ if self.0 & 1 == 1 { 0xd000_0001 } else { 0 };
//!         call.set_scalar('d', (self.0 >> (32 - call.operands.immediate('i'))) as i32);
//!         Ok(Ending::DONE)
//!     }
//! }
//! ```

mod call;
mod units;

use std::sync::Arc;
use std::{fmt, ops::Range};

use dyn_clone::DynClone;
use isa::Isa;
use isa::table::Op;
use messages::{Diagnostic, did_you_mean};

pub use call::{Call, Operands};
use units::TypedUnit;
pub(crate) use units::{Unit, Units};

pub use crate::semantics::Numbers;

use crate::code::Code;
use crate::code::trap::Fault;

/// Meaning of an extension instruction.
///
/// What is attached is the state after reset: each core works with a clone of it, and begins each work item with a new one, so that a
/// work item's result depends on nothing but its message ([`Meaning::keeps_state`] says otherwise). A meaning is to be a function of that
/// state and of what it is called with: no clock, no host's random numbers, nothing that threads share.
pub trait Meaning: DynClone + fmt::Debug + Send + Sync + 'static {
    /// The octets of global memory that the instruction reads, in one transfer, before it is executed; the core waits for the bus as in a
    /// `load`. It may be asked more than once for one execution.
    ///
    /// The length is rounded up to whole words; [`Call::words`] has them. At most [`MOST_OCTETS`].
    fn reads(&self, _operands: &Operands) -> Option<Range<u32>> {
        None
    }

    /// Executes the instruction once. Results become visible when it has ended; destinations `d` and `e` that it does not write become zero,
    /// `x` and `y` stay.
    ///
    /// # Errors
    /// What stops the machine: a trap at the instruction, which then has written no register. [`Fault::Refused`] carries a text.
    fn execute(&mut self, call: &mut Call) -> Result<Ending, Fault>;

    /// True where a core keeps the state from one work item to the next, as a cache does. Frames are then stepped in the order of the machine's
    /// clocks instead of replayed, and what a work item computes may depend on the machine.
    fn keeps_state(&self) -> bool {
        false
    }
}

dyn_clone::clone_trait_object!(Meaning);

impl Meaning for Box<dyn Meaning> {
    fn reads(&self, operands: &Operands) -> Option<Range<u32>> {
        (**self).reads(operands)
    }

    fn execute(&mut self, call: &mut Call) -> Result<Ending, Fault> {
        (**self).execute(call)
    }

    fn keeps_state(&self) -> bool {
        (**self).keeps_state()
    }
}

/// Most octets that an instruction with a meaning in Rust reads at once.
pub const MOST_OCTETS: u32 = 1 << 16;

/// Ending of an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ending {
    /// Number of the exit in the row, from 0.
    pub exit: u8,
    /// Units that the exit costs by `each`.
    pub units: u32,
    /// The program goes on where the instruction's distance leads.
    pub is_taken: bool,
}

impl Ending {
    /// The row's first exit.
    pub const DONE: Ending = Ending::exit(0);

    /// An exit by its number in the row, from 0.
    pub const fn exit(exit: u8) -> Ending {
        Ending { exit, units: 0, is_taken: false }
    }

    /// Ending with units of what the exit costs by `each`.
    pub const fn with_units(self, units: u32) -> Ending {
        Ending { units, ..self }
    }

    /// Ending that goes on where the instruction's distance (`Rel`) leads.
    pub const fn taken(self) -> Ending {
        Ending { is_taken: true, ..self }
    }
}

/// Attachment that an instruction set keeps for an instruction with a meaning.
struct Attached(Box<dyn Unit>);

/// Says what the instruction of an extension does: from then on, every run on this instruction set executes the meaning, in the place of the
/// instruction's body if it has one.
///
/// # Errors
/// No such instruction, one of the table's, or one that costs what its body does: what a meaning spends, nobody can count.
pub fn attach(isa: &mut Isa, name: &str, meaning: impl Meaning + Clone) -> Result<(), Box<Diagnostic>> {
    let op = match isa.find(name) {
        Some(op @ Op::Ext(_)) => op,
        Some(_) => {
            let message = format!("`{name}` is an instruction of the table, whose meaning stays as it is");
            return Err(Box::new(
                Diagnostic::error(message).hint("declare one of another name in a file of extensions"),
            ));
        }
        None => {
            let message = Diagnostic::error(format!("there is no instruction `{name}`"));
            let names: Vec<&str> = isa.extensions().map(|op| &*isa.definition(op).name).collect();
            return Err(Box::new(message.hint(
                did_you_mean(name, names).unwrap_or_else(|| "load the file that declares it first".to_owned()),
            )));
        }
    };
    if isa.definition(op).outcomes.iter().any(|exit| exit.is_body) {
        let message = format!("`{name}` costs what its body does, but its meaning in Rust would be executed instead");
        return Err(Box::new(Diagnostic::error(message).hint("declare what its exits cost, such as `[Done(add 3)]`")));
    }
    let unit = TypedUnit::new(isa.definition(op), meaning);
    isa.set_semantics(op, Some(Arc::new(Attached(Box::new(unit)))));
    Ok(())
}

/// The meaning that is attached to an instruction.
pub fn of(isa: &Isa, op: Op) -> Option<&dyn Meaning> {
    attached(isa, op).map(|attached| attached.0.meaning())
}

/// Unit that executes an instruction, as it is after reset.
fn attached(isa: &Isa, op: Op) -> Option<&Attached> {
    isa.semantics(op)?.downcast_ref()
}

/// Some instruction of a program has a meaning that keeps its state from one work item to the next.
pub(crate) fn keeps_state(code: &Code) -> bool {
    let kept = |op| of(code.isa, op).is_some_and(Meaning::keeps_state);
    code.slots().iter().any(|slot| matches!(slot.op, Some(op @ Op::Ext(_)) if kept(op)))
}
