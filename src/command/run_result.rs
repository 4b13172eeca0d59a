//! Results of `lancer run`: as JSON and as tables.

use std::borrow::Cow;

use emu::machine::one_core::OneCoreRun;
use emu::profile::Profile;
use isa::{Class, Program};
use messages::Diagnostic;
use schemars::JsonSchema;
use serde::Serialize;

use super::run_arguments::Dump;
use crate::failure::Failure;
use crate::numeral::{count, grouped};
use crate::registers::{self, RegisterValues, ShowRequest, ShownRegister};
use crate::result::{ByClass, Loss, RegionCounts, hexadecimal, loss_table, octet_rows, regions};
use crate::shadow::{ShadowResult, shadow_text};
use crate::summary;
use crate::table::{row, table};

/// Version of [`RunResult`].
pub const SCHEMA: &str = "lancer-run-1";

/// Kinds of data of a program that runs by itself: its memory has no names.
const KINDS: [&str; 2] = ["messages", "other"];

/// The results of a program.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RunResult {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// The assembly file.
    pub program: String,
    /// Name of the machine.
    pub machine: String,
    /// Engine that was chosen: native (which leaves what runs briefly to the interpreter) or checked.
    pub engine: &'static str,
    /// Reason for which a faster engine that was wanted was not chosen; `None` where it did.
    pub engine_because: Option<&'static str>,
    /// Instructions executed.
    pub instructions: u64,
    /// Operations by class.
    pub counts: ByClass,
    /// Clocks, transfers included.
    pub clocks: u64,
    /// Clocks of transfers.
    pub waiting: u64,
    /// Registers at the end: those that are not zero, or all when they were asked for.
    pub registers: RegisterValues,
    /// Registers that were asked for, by `--show`, or by `--dump regs` those of the key `registers`, with their real values.
    pub shown: Vec<ShownRegister>,
    #[serde(skip)]
    listed: Vec<ShownRegister>,
    /// Functions.
    pub functions: Vec<RegionCounts>,
    /// Regions inside functions.
    pub regions: Vec<RegionCounts>,
    /// Instructions of whose results some lost bits or did not fit; left out unless it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flags: Option<Vec<Loss>>,
    /// The results beside exact arithmetic on the same inputs; left out unless it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shadow: Option<ShadowResult>,
    /// Octets that were asked for.
    pub dumps: Vec<DumpedOctets>,
    /// The trap that stopped it before its `halt`.
    pub trap: Option<TrapResult>,
}

/// Octets of a memory.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct DumpedOctets {
    /// `memory` or `buffer`.
    pub space: &'static str,
    /// Address of the first one.
    pub address: u32,
    /// In hexadecimal.
    pub octets: String,
    #[serde(skip)]
    raw: Vec<u8>,
}

/// The trap of a program.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct TrapResult {
    /// Kind of the trap, without its place.
    pub fault: String,
    /// Word of the instruction.
    pub pc: u32,
    /// The function around it.
    pub function: Option<String>,
    /// `file:line`.
    pub place: Option<String>,
}

impl RunResult {
    /// The results of a run.
    ///
    /// # Errors
    /// A dump beyond the end of a memory.
    pub fn new(
        file: String,
        machine: String,
        program: &Program,
        run: &OneCoreRun,
        flags: Option<Vec<Loss>>,
        dumps: &[Dump],
        shown: &[ShowRequest],
    ) -> Result<RunResult, Failure> {
        // Registers that are zero are left out unless all are asked for.
        let has_all = dumps.contains(&Dump::Registers { has_zeros: true });
        let state = &run.state;
        let kept = registers::all(&state.registers).filter(|(_, contents)| has_all || !contents.is_zero());
        let kept: Vec<_> = kept.collect();
        let is_dumped = dumps.iter().any(|dump| matches!(dump, Dump::Registers { .. }));
        let listed = kept.iter().map(|(register, _)| ShownRegister::at(program, &state.registers, *register, state.pc));
        let listed: Vec<ShownRegister> = listed.collect();
        let shown = match shown.is_empty() {
            true if is_dumped => listed.clone(),
            true => Vec::new(),
            false => {
                let wanted = shown.iter().map(|request| request.shown(program, &state.registers, state.pc));
                wanted.collect::<Result<_, _>>().map_err(|message| Failure::usage(Diagnostic::error(message)))?
            }
        };
        let trap = run.trap.as_ref().map(|trap| TrapResult {
            fault: trap.kind.to_string(),
            pc: trap.pc,
            function: trap.function.clone(),
            place: trap.place.clone(),
        });
        Ok(RunResult {
            schema: SCHEMA,
            program: file,
            machine,
            engine: run.engine.kind.name(),
            engine_because: run.engine.refusal,
            instructions: run.state.steps,
            counts: ByClass(run.profile.as_ref().map(Profile::total).unwrap_or_default()),
            clocks: run.clocks.0,
            waiting: run.waiting.0,
            registers: RegisterValues(
                kept.iter().map(|(register, contents)| (registers::name(*register), *contents)).collect(),
            ),
            listed: if shown.is_empty() { listed } else { Vec::new() },
            shown,
            functions: regions(run.profile.as_ref(), &KINDS, true),
            regions: regions(run.profile.as_ref(), &KINDS, false),
            flags,
            shadow: None,
            dumps: dumps.iter().filter_map(|&dump| dumped(run, dump)).collect::<Result<_, _>>()?,
            trap,
        })
    }

    /// Registers, counts, functions and dumps for people.
    pub fn text(&self) -> String {
        // Registers, operations by class, functions, losses, dumps and the end, each with a line between.
        let mut parts = vec![self.register_text()];
        let mut rows = vec![row(["class", "count"])];
        rows.extend(
            self.counts
                .0
                .iter()
                .filter(|(_, count)| *count != 0)
                .map(|(class, count)| vec![class.name().into(), grouped(count)]),
        );
        if rows.len() > 1 {
            parts.push(table(rows));
        }
        if self.functions.iter().chain(&self.regions).any(|region| region.calls != 0) {
            parts.push(summary::function_table(&[(&self.functions, ""), (&self.regions, "  ")]));
        }
        parts.extend(self.flags.as_deref().map(loss_table));
        parts.extend(self.shadow.as_ref().map(shadow_text));
        for dump in &self.dumps {
            parts.push(format!("{}\n{}", dump.space, octet_rows(&dump.raw, dump.address)));
        }
        let ended = if self.trap.is_some() { "stopped" } else { "halted" };
        parts.push(format!(
            "{ended} after {}, {} ({} of them on the bus, {} octets)\n",
            count(self.instructions, "instruction", "instructions"),
            count(self.clocks, "clock", "clocks"),
            grouped(self.waiting),
            grouped(self.counts.0[Class::Octet]),
        ));
        parts.join("\n") + &summary::engine(self.engine, self.engine_because)
    }

    fn register_text(&self) -> String {
        let registers = if self.shown.is_empty() { &self.listed } else { &self.shown };
        match registers.is_empty() {
            true => "all registers are zero\n".into(),
            false => table(registers::rows(registers)),
        }
    }
}

fn dumped(run: &OneCoreRun, dump: Dump) -> Option<Result<DumpedOctets, Failure>> {
    let (space, address, octets) = match dump {
        Dump::Registers { .. } => return None,
        Dump::Memory(address, octets) => ("memory", address, run.memory.slice(address, octets)),
        Dump::Buffer(address, octets) => ("buffer", address, run.state.buffer.slice(address, octets).map(Cow::from)),
    };
    let dumped =
        |octets: Cow<[u8]>| DumpedOctets { space, address, octets: hexadecimal(&octets), raw: octets.into_owned() };
    Some(octets.map(dumped).map_err(|fault| Diagnostic::error(format!("there is nothing to dump: {fault}")).into()))
}
