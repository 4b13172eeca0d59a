//! A frame in parts: each is drawn as a frame of its own on a server's machine, and has to show what the whole frame shows there.

use emu::machine::{Config, RunOptions, RunOutcome};
use kernels::KernelOptions;
use kernels::build::Crop;
use messages::Diagnostic;
use scenes::image::{MemoryImage, MemoryKind};
use scenes::layout::PIXEL;

use super::{
    FrameDivision, MESSAGE, PartCost, PixelGoal, SCHEMA, SceneHome, ServedFrame, ServerLink, ServersCurve, ServersPlan,
    ServersPoint, ServersResult, serve,
};
use crate::drawing;
use crate::failure::Failure;
use crate::job::{Job, result_name};
use crate::load::Load;
use crate::numeral::share;
use crate::result::image_hash;

/// Parts of a frame, drawn.
pub(super) struct DrawnParts {
    /// Clocks and answer of each.
    pub costs: Vec<PartCost>,
    /// Octets that the buses of the servers moved for them.
    pub bus_octets: u64,
}

/// A frame that is to be divided, drawn as a whole.
pub(super) struct DividedFrame<'a> {
    job: &'a Job,
    plan: &'a ServersPlan,
    load: Load,
    image: MemoryImage,
    pub crop: Crop,
    /// Machine of a server.
    config: Config,
    /// Run of the whole frame on one machine that is no server.
    alone: RunOutcome,
    /// Pixels of the whole frame.
    words: Vec<[i32; 3]>,
    /// Octets of the scene.
    scene_octets: u64,
}

/// The machine of a server whose memory lies behind a link: each burst waits for the way there and back, and comes as fast as the slower of
/// bus and link.
fn behind(config: &Config, link: ServerLink) -> Config {
    let mut config = config.clone();
    let bus = &mut config.bus;
    bus.setup_clocks = bus.setup_clocks.saturating_add(link.latency_clocks.saturating_mul(2));
    if link.octets_per_clock * bus.clocks_per_beat < bus.octets_per_beat {
        (bus.octets_per_beat, bus.clocks_per_beat) = (link.octets_per_clock, 1);
    }
    config
}

impl<'a> DividedFrame<'a> {
    /// Draws the frame as a whole.
    pub fn new(job: &'a Job, plan: &'a ServersPlan) -> Result<DividedFrame<'a>, Failure> {
        let (load, mut image) = Load::picture(job)?;
        // Programs of other parts are put together from what lies in memory.
        image.bytes = load.memory.octets().into_owned();
        let crop = load.build.crop;
        let options = RunOptions { engine: load.engine, ..RunOptions::default() };
        let alone = emu::run(&load.setup(&job.machine, options), load.memory.clone(), &mut |_| {})?;
        let words = drawing::colour_words(&image, &alone, &crop);
        let is_scene = |kind: MemoryKind| !matches!(kind, MemoryKind::Header | MemoryKind::Frame);
        let scene = image.regions.iter().filter(|(kind, _)| is_scene(*kind));
        let scene_octets = scene.map(|(_, range)| u64::from(range.end - range.start)).sum();
        let config = match plan.home {
            SceneHome::Copied => job.machine.clone(),
            SceneHome::Shared => behind(&job.machine, plan.link),
        };
        Ok(DividedFrame { job, plan, load, image, crop, config, alone, words, scene_octets })
    }

    /// Pixels of the frame.
    pub fn pixels(&self) -> u64 {
        u64::from(self.crop.width) * u64::from(self.crop.height)
    }

    /// Clock rate of the machines in hertz.
    pub fn clock_hz(&self) -> u64 {
        self.config.clock_hz
    }

    /// Clocks of the frame on one machine.
    pub fn alone_clocks(&self) -> u64 {
        self.alone.clocks.0
    }

    /// Tiles of a size, row by row; those at the right and below may be smaller.
    pub fn tiles(&self, (width, height): (u32, u32)) -> Vec<Crop> {
        let Crop { column: left, row: top, width: columns, height: rows } = self.crop;
        let along = |first: u32, length: u32, step: u32| {
            (0..length).step_by(step as usize).map(move |at| (first + at, step.min(length - at)))
        };
        let tiles = along(top, rows, height).flat_map(|(row, height)| {
            along(left, columns, width).map(move |(column, width)| Crop { column, row, width, height })
        });
        tiles.collect()
    }

    /// Bands of rows, one a server; the first ones are a row higher where not all can be as high.
    pub fn bands(&self, servers: u32) -> Vec<Crop> {
        let used = servers.min(self.crop.height);
        let (height, higher) = (self.crop.height / used, self.crop.height % used);
        let first = |band: u32| self.crop.row + band * height + band.min(higher);
        (0..used).map(|band| Crop { row: first(band), height: first(band + 1) - first(band), ..self.crop }).collect()
    }

    /// Draws parts one after the other.
    pub fn draw(&self, parts: &[Crop], progress: &dyn Fn(u64)) -> Result<DrawnParts, Failure> {
        let mut drawn = DrawnParts { costs: Vec::with_capacity(parts.len()), bus_octets: 0 };
        for part in parts {
            let frame = self.draw_part(*part)?;
            let pixels = u64::from(part.width) * u64::from(part.height);
            let answer = match self.plan.home {
                SceneHome::Copied => pixels * u64::from(PIXEL.octets()),
                SceneHome::Shared => MESSAGE,
            };
            drawn.costs.push(PartCost { clocks: frame.clocks.0, answer });
            drawn.bus_octets += frame.bus.moved.0;
            progress(pixels);
        }
        Ok(drawn)
    }

    /// Draws a part, and compares its pixels with those of the whole frame.
    fn draw_part(&self, part: Crop) -> Result<RunOutcome, Failure> {
        let Job { scene, view, isa, kernels, .. } = self.job;
        let options = KernelOptions { crop: Some(part), ..kernels.clone() };
        let build = kernels::build(scene, view, &self.image, isa, &options)?;
        let options = RunOptions { engine: self.load.engine, ..RunOptions::default() };
        let setup =
            emu::machine::Setup { core: &build.cores, main: &build.main, ..self.load.setup(&self.config, options) };
        let frame = emu::run(&setup, self.load.memory.clone(), &mut |_| {})?;
        let words = drawing::colour_words(&self.image, &frame, &part);
        let whole = (part.row..part.row + part.height).flat_map(|row| {
            let at =
                (row - self.crop.row) as usize * self.crop.width as usize + (part.column - self.crop.column) as usize;
            &self.words[at..at + part.width as usize]
        });
        if !whole.eq(&words) {
            let Crop { column, row, width, height } = part;
            let message = format!("the part {column},{row},{width},{height} is not what the whole frame shows there");
            return Err(Diagnostic::error(message)
                .hint("kernels of your own may use what other pixels leave behind")
                .into());
        }
        Ok(frame)
    }

    /// A number of servers that draw these parts.
    pub fn point(&self, servers: u32, drawn: &DrawnParts, division: FrameDivision) -> ServersPoint {
        let is_shared = self.plan.home == SceneHome::Shared;
        let (frame, first_clocks, parts, bus_octets) = if servers == 1 {
            // One server is the machine as it is: it has the frame as a whole, and nothing passes a link.
            let clocks = self.alone_clocks();
            (ServedFrame { clocks, busy: vec![clocks], ..ServedFrame::default() }, clocks, 1, self.alone.bus.moved.0)
        } else {
            let on = |scene| serve(&drawn.costs, servers, division.order(), self.plan.link, scene);
            let first = on(if is_shared { 0 } else { self.scene_octets });
            (on(0), first.clocks, drawn.costs.len() as u32, drawn.bus_octets)
        };
        let seconds = frame.clocks as f64 / self.clock_hz() as f64;
        let speed_up = share(self.alone_clocks(), frame.clocks);
        ServersPoint {
            servers,
            parts,
            clocks: frame.clocks,
            first_clocks,
            seconds,
            pixel_seconds: seconds / self.pixels() as f64,
            speed_up,
            efficiency: speed_up / f64::from(servers),
            least_busy: match frame.busy.iter().min() {
                Some(&least) if frame.busy.len() == servers as usize => share(least, frame.clocks),
                _ => 0.0,
            },
            mean_busy: share(frame.busy.iter().sum(), frame.clocks) / f64::from(servers),
            port_octets: frame.octets,
            port_busy: share(frame.port_busy, frame.clocks),
            bus_octets,
            shared_octets_per_clock: (is_shared && servers > 1).then(|| share(bus_octets, frame.clocks)),
        }
    }

    /// The result with its curves.
    pub fn result(self, curves: Vec<ServersCurve>, goal: PixelGoal) -> ServersResult {
        let size = (self.crop.width, self.crop.height);
        ServersResult {
            schema: SCHEMA,
            scene: result_name(&self.job.scene),
            machine: self.job.machine_name.clone(),
            width: size.0,
            height: size.1,
            clock_hz: self.clock_hz(),
            home: self.plan.home,
            link: self.plan.link,
            scene_octets: self.scene_octets,
            image_hash: image_hash(size, &self.words),
            alone_clocks: self.alone_clocks(),
            alone_pixel_seconds: self.alone.seconds(self.clock_hz()) / self.pixels() as f64,
            curves,
            table_3: kernels::annex::peers().to_vec(),
            goal,
        }
    }
}
