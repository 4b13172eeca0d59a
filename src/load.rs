//! Work for a machine, apart from the machine: programs, global memory and its kinds of data. A picture is
//! one such load, the report's estimate of a picture another.

use emu::engine::EngineKind;
use emu::machine::{Config, RunOptions, Setup};
use emu::octets::Memory;
use isa::Isa;
use kernels::annex::load;
use kernels::build::Build;
use messages::Report;
use scenes::cadrage::Formats;
use scenes::image::{self, MemoryImage, MemoryKind};

use crate::energy::MeasuredPrograms;
use crate::failure::Failure;
use crate::job::Job;

/// Name of the report's estimate where a scene may be named.
pub const ANNEX: &str = "annex";

/// Pixels of the report's estimate.
pub const ANNEX_PIXELS: u32 = 1_000;

/// Programs and memory for a machine.
#[derive(Clone, Debug)]
pub struct Load {
    /// The rows of the programs.
    pub isa: Isa,
    /// The programs.
    pub build: Build,
    /// Global memory.
    pub memory: Memory,
    /// Names for ranges of it.
    pub kinds: Vec<(std::ops::Range<u32>, String)>,
    /// Formats of the picture; none of the report's estimate.
    pub formats: Option<Formats>,
    /// Engine that executes the programs.
    pub engine: EngineKind,
}

/// Name of a kind of data where its octets are counted.
fn traffic(kind: MemoryKind) -> &'static str {
    match kind {
        MemoryKind::Frame => "pixels",
        kind => kind.name(),
    }
}

impl Load {
    /// The picture of a job, with the description of its memory; the octets have moved into the load.
    ///
    /// # Errors
    /// A scene that does not fit its formats, errors in the user's kernels.
    pub fn picture(job: &Job) -> Result<(Load, MemoryImage), Failure> {
        let isa = job.isa.clone();
        let mut image = image::build(&job.scene, &job.view, &job.memory())?;
        let build = kernels::build(&job.scene, &job.view, &image, &isa, &job.kernels)?;
        let kinds = image.regions.iter().map(|(kind, range)| (range.clone(), traffic(*kind).to_owned())).collect();
        let memory = Memory::new(std::mem::take(&mut image.bytes));
        Ok((Load { isa, build, memory, kinds, formats: Some(image.formats), engine: job.engine }, image))
    }

    /// The report's estimate of `ANNEX_PIXELS` pixels.
    ///
    /// # Errors
    /// None that a user could make.
    pub fn annex() -> Result<Load, Failure> {
        let isa = Isa::base();
        let (cores, main) = load::programs(ANNEX_PIXELS, &isa)?;
        let crop = kernels::build::Crop { column: 0, row: 0, width: ANNEX_PIXELS, height: 1 };
        let build = Build { cores, main, crop, warnings: Report::default() };
        let memory = Memory::new(vec![0; load::MEMORY]);
        Ok(Load { isa, build, memory, kinds: Vec::new(), formats: None, engine: EngineKind::default() })
    }

    /// The programs, for their energy.
    pub fn programs(&self) -> MeasuredPrograms<'_> {
        MeasuredPrograms { isa: &self.isa, cores: &self.build.cores, main: &self.build.main }
    }

    /// The load on a machine.
    pub fn setup<'a>(&'a self, config: &'a Config, options: RunOptions) -> Setup<'a> {
        Setup {
            config,
            isa: &self.isa,
            core: &self.build.cores,
            main: &self.build.main,
            kinds: self.kinds.clone(),
            options,
        }
    }
}
