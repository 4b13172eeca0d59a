//! Faults on purpose: a campaign of injections into a picture's frame, each of which follows from its number alone, and what comes of them.
//! Faults are carried out by `emu::inject`.

mod cost;
#[cfg(feature = "cli")]
mod heat;
pub mod part;
mod place;
pub mod result;
pub mod row;
pub mod statistics;
#[cfg(feature = "cli")]
mod text;
pub mod unprotected;

use std::ops::{Range, RangeInclusive};

use emu::inject::{
    FaultKind, FlipRequest, FlipShape, GoldenFrame, InjectedEnd, InjectedFlip, MOST_TRANSFERS, Protection, inject,
};
use emu::machine::config::ProtectionConfig;
use emu::machine::{RunOptions, Setup};
use emu::octets::Memory;
use messages::Diagnostic;
use random::SplitMix64;
use rayon::prelude::*;
use scenes::image::{MemoryImage, MemoryKind};
use scenes::layout::PIXEL;
use scenes::metrics;

pub use cost::{ProtectionCost, costs as protection_costs};
#[cfg(feature = "cli")]
pub use heat::map;
#[cfg(feature = "cli")]
pub use text::{one, text};

use crate::failure::Failure;
use crate::job::Job;
use crate::load::Load;
use crate::settings::{Settings, VERSION, hash};
use row::{InjectionClass, InjectionRow};

/// Version of [`result::InjectResult`].
pub const SCHEMA: &str = "lancer-inject-2";

/// Injections that share a part: few enough that a run which is stopped loses little.
pub const BLOCK: u64 = 500;

/// Injections that a host thread takes at a time.
const AT_ONCE: usize = 20;

/// Injections of a campaign.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FaultCampaign {
    /// Structures in the order in which results have them.
    pub kinds: Vec<FaultKind>,
    /// Injections into each.
    pub injections: u64,
    /// Bits that flip together.
    pub shape: FlipShape,
    /// Beginning of all series of random numbers.
    pub seed: u64,
    /// Protected structures: those of the machine.
    pub protections: ProtectionConfig,
}

impl FaultCampaign {
    /// Protection of a structure.
    pub fn protection(&self, kind: FaultKind) -> Protection {
        self.protections.of(kind)
    }

    /// Flip of an injection: a function of seed, structure, shape, protection and number.
    pub fn request(&self, kind: FaultKind, number: u64) -> FlipRequest {
        let mut state = SplitMix64::new(self.seed).bits();
        for octet in kind.name().bytes() {
            state = SplitMix64::new(state ^ u64::from(octet)).bits();
        }
        let seed = SplitMix64::new(state ^ number).bits();
        FlipRequest { target: kind, shape: self.shape, seed, protection: self.protection(kind) }
    }

    /// The injections in blocks, structure after structure.
    pub fn blocks(&self) -> Vec<(FaultKind, Range<u64>)> {
        let of = |kind| {
            let starts = (0..self.injections).step_by(BLOCK as usize);
            starts.map(move |from| (kind, from..(from + BLOCK).min(self.injections)))
        };
        self.kinds.iter().copied().flat_map(of).collect()
    }

    /// Hash of all that an injection depends on beside its structure and its number.
    pub fn identity(&self, job: &Job) -> String {
        let settings = serde_json::to_string(&Settings { engine: Default::default(), ..Settings::of(job) });
        let protections: Vec<&str> =
            self.protections.iter().flat_map(|(kind, protection)| [kind.name(), protection.name()]).collect();
        let own = format!(
            "{} {} {} {} {}",
            self.seed,
            self.shape.bits,
            self.shape.pattern.name(),
            SCHEMA,
            protections.join(" ")
        );
        hash::texts([settings.expect("settings have string keys").as_str(), &own, VERSION])
    }
}

/// Programs and memory of a picture in which faults are put.
pub struct FaultLoad {
    load: Load,
    image: MemoryImage,
}

impl FaultLoad {
    /// Tree, memory image and programs of a job.
    ///
    /// # Errors
    /// See [`Load::picture`].
    pub fn new(job: &Job) -> Result<FaultLoad, Failure> {
        let (load, image) = Load::picture(job)?;
        Ok(FaultLoad { load, image })
    }

    /// The load on a job's machine.
    pub fn setup<'a>(&'a self, job: &'a Job) -> Setup<'a> {
        self.load.setup(&job.machine, RunOptions::default())
    }
}

/// A frame without a fault, and all that is asked of those with one.
pub struct FaultFrame<'a> {
    /// The frame.
    pub golden: GoldenFrame<'a>,
    load: &'a FaultLoad,
    /// Octets of the frame's pixels.
    pixels: Range<u32>,
    colours: Vec<u8>,
}

impl<'a> FaultFrame<'a> {
    /// Runs the frame without a fault, for faults of these kinds.
    ///
    /// # Errors
    /// See [`GoldenFrame::up_to`].
    pub fn new(load: &'a FaultLoad, setup: &'a Setup<'a>, kinds: &[FaultKind]) -> Result<FaultFrame<'a>, Failure> {
        // Only faults of grants need all work items recorded at once.
        let is_recorded = kinds.iter().any(|kind| kind.is_of_clocks());
        let most_transfers = if is_recorded { MOST_TRANSFERS } else { u64::MAX };
        let golden = GoldenFrame::up_to(setup, &load.load.memory, most_transfers)?;
        let pixels = load.image.region(MemoryKind::Frame);
        let colours = octets(golden.memory(), &pixels);
        Ok(FaultFrame { golden, load, pixels, colours })
    }

    /// Checks that a campaign's faults can be put into the frame.
    ///
    /// # Errors
    /// A machine that stops without a fault, where faults of its grants are wanted.
    pub fn check(&self, campaign: &FaultCampaign) -> Result<(), Failure> {
        let Some(kind) = campaign.kinds.iter().find(|kind| kind.is_of_clocks()) else { return Ok(()) };
        let Err(failure) = self.golden.clocks() else { return Ok(()) };
        let message = format!("{} needs a machine that comes to its end without a fault: {failure}", kind.name());
        let report = Diagnostic::error(message).hint("name the kinds that flip bits: `--kind registers`").into();
        let Failure::Message { exit, .. } = Failure::from(failure) else { return Ok(()) };
        Err(Failure::Message { report, exit })
    }

    /// Rows of injections by their numbers, computed on all host threads, in order.
    pub fn run(&self, campaign: &FaultCampaign, kind: FaultKind, numbers: RangeInclusive<u64>) -> Vec<InjectionRow> {
        let numbers: Vec<u64> = numbers.collect();
        let portion = |numbers: &[u64]| -> Vec<InjectionRow> {
            let requests: Vec<FlipRequest> = numbers.iter().map(|&number| campaign.request(kind, number)).collect();
            let injected = inject(&self.golden, &requests);
            numbers.iter().zip(injected).map(|(&number, injected)| self.row(number, &injected)).collect()
        };
        numbers.par_chunks(AT_ONCE).flat_map_iter(portion).collect()
    }

    fn row(&self, number: u64, injected: &InjectedFlip) -> InjectionRow {
        let InjectedFlip { flip, hit, end, items } = injected;
        let place = place::FaultPlace::new(flip, hit, &self.golden, &self.load.image);
        let mut row = InjectionRow {
            kind: flip.target.name().to_owned(),
            number,
            class: InjectionClass::Masked,
            item: flip.item,
            pixel: self
                .golden
                .message(flip.item)
                .filter(|_| !flip.target.is_of_clocks())
                .map(|message| message.first()[0]),
            moment: flip.moment,
            structure: place.structure,
            place: place.place,
            function: place.function,
            format: place.format,
            format_bits: place.format_bits,
            bits: place::bits_of(flip.mask).map(|bit| bit + place.bits_below).collect(),
            change: hit.change,
            wrong_pixels: 0,
            largest_difference: 0.0,
            trap: None,
            trap_at: None,
            limit: None,
            steps: None,
            items: *items,
        };
        match end {
            InjectedEnd::Corrected => row.class = InjectionClass::Corrected,
            InjectedEnd::Detected => row.class = InjectionClass::Detected,
            InjectedEnd::Trap { fault, core, pc } => {
                row.class = InjectionClass::Trap;
                row.trap = Some(row::trap_name(fault).to_owned());
                let function = self.golden.function(*core, *pc).map_or_else(String::new, |name| format!(" in {name}"));
                row.trap_at = Some(format!("core {core}, word {pc}{function}"));
            }
            InjectedEnd::Hang { limit, steps } => {
                row.class = InjectionClass::Hang;
                (row.limit, row.steps) = (Some(limit.name().to_owned()), Some(*steps));
            }
            // A picture whose clocks alone are others has wrong counts.
            InjectedEnd::Frame { counts_differ, memory } => {
                (row.wrong_pixels, row.largest_difference) =
                    memory.as_ref().map_or((0, 0.0), |memory| self.differences(memory));
                row.class = match (row.wrong_pixels, counts_differ) {
                    (0, false) => InjectionClass::Masked,
                    (0, true) => InjectionClass::WrongCounts,
                    _ => InjectionClass::WrongPixel,
                };
            }
        }
        row
    }

    /// Pixels that are not those of the frame without a fault, and the largest difference of a component, both clamped to [0, 1].
    fn differences(&self, memory: &Memory) -> (u64, f64) {
        let scale = (-f64::from(self.load.image.formats.colour)).exp2();
        let colour = |pixel: &[u8]| -> [f64; 3] {
            let (words, _) = pixel.as_chunks::<4>();
            [0, 1, 2].map(|k| words.get(k).map_or(0.0, |&word| f64::from(i32::from_le_bytes(word)) * scale))
        };
        let (mut wrong, mut largest) = (0, 0.0f64);
        let (found, size) = (octets(memory, &self.pixels), PIXEL.octets() as usize);
        for (one, other) in found.chunks(size).zip(self.colours.chunks(size)).filter(|(one, other)| one != other) {
            wrong += 1;
            largest = largest.max(metrics::difference(colour(one), colour(other)));
        }
        // Decimal fractions of few digits are read back from a part as they were written.
        (wrong, (largest * 1e12).floor() / 1e12)
    }
}

fn octets(memory: &Memory, range: &Range<u32>) -> Vec<u8> {
    memory.slice(range.start, range.end - range.start).map_or_else(|_| Vec::new(), std::borrow::Cow::into_owned)
}
