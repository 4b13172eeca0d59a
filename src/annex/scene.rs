//! The rows of the annexes on a scene: what a call of each row's region takes where nothing is assumed.

use emu::profile::{Profile, RegionProfile};
use kernels::KernelSet;
use kernels::annex::rows;

use crate::drawing::Drawing;
use crate::job::{Detail, Job, result_name};
use crate::result::Render;
use scenes::model::Scene;

/// The rows' regions on a scene, and what a pixel took.
#[derive(Clone, Debug)]
pub struct OnScene {
    /// Name of the scene.
    pub scene: String,
    /// The regions in the order of the rows; `None` where the scene's programs do not have it.
    pub regions: Vec<Option<RegionProfile>>,
    /// Pixels.
    pub pixels: u64,
    /// Elementary operations of all cores.
    pub operations: u64,
    /// Octets that the cores moved.
    pub octets: u64,
    /// Clocks of the frame.
    pub clocks: u64,
    /// Clocks of the machine a second.
    pub clock_hz: u64,
    /// Cores of the machine.
    pub cores: u32,
    /// Rays of all kinds.
    pub rays: u64,
    /// Octets of the local buffer that the cores' program uses.
    pub buffer_octets: u64,
    /// Triangles, nodes of the kd tree and references.
    pub stored: [u64; 3],
}

/// The job that draws a scene as the annexes assume: the report's kernels, layout and machine.
pub fn job(scene: Scene, size: (u32, u32)) -> Job {
    let mut job = Job::new(scene);
    job.view.size = size;
    job.kernels.profile = KernelSet::Report;
    job.detail = Detail::Extremes;
    job
}

impl OnScene {
    /// Seconds of the frame.
    pub fn seconds(&self) -> f64 {
        self.clocks as f64 / self.clock_hz as f64
    }

    /// Figures from a drawing of such a job.
    pub fn new(job: &Job, drawing: &Drawing) -> OnScene {
        let frame = &drawing.frame;
        let profiles: Vec<&Profile> = [&frame.profile, &frame.main_profile].into_iter().flatten().collect();
        let find = |name: &str| {
            let mut regions = profiles.iter().flat_map(|profile| &profile.regions);
            regions.find(|region| region.name == name && region.calls != 0).cloned()
        };
        let tree = drawing.image.tree;
        OnScene {
            scene: result_name(&job.scene),
            regions: rows().iter().map(|row| find(&row.region)).collect(),
            pixels: drawing.words.len() as u64,
            operations: frame.profile.as_ref().map(Profile::total).unwrap_or_default().elementary(),
            octets: frame.processors.iter().take(job.machine.cores as usize).map(|core| core.octets.0).sum(),
            clocks: frame.clocks.0,
            clock_hz: job.machine.clock_hz,
            cores: job.machine.cores,
            rays: Render::new(job, drawing).rays.all(),
            buffer_octets: drawing.build.cores.buffer.len() as u64,
            stored: [drawing.image.counts.triangles.into(), tree.nodes as u64, tree.references as u64],
        }
    }
}
