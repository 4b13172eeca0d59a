//! Frames that several coprocessors draw together (report 6.4): each server is a whole machine with its own cores, bus and memory, the frame
//! is divided among them, and a link carries scene, requests and pixels. Parts are replayed to the clock; what passes the link is scheduled
//! event by event. What is printed or drawn of it is said in the files below.

#[cfg(feature = "cli")]
mod chart;
mod goal;
mod parts;
mod schedule;
#[cfg(feature = "cli")]
mod text;

use kernels::annex::Peer;
use messages::{Diagnostic, Report};
use schemars::JsonSchema;
use serde::{Serialize, Serializer};

#[cfg(feature = "cli")]
pub use chart::figure;
use goal::GoalSearch;
use parts::DividedFrame;
pub use schedule::{MESSAGE, PartCost, PartOrder, ServedFrame, ServerLink, serve};
#[cfg(feature = "cli")]
pub use text::{csv, text};

use crate::failure::Failure;
use crate::job::Job;

/// Version of [`ServersResult`]: a key that goes away or changes its meaning changes it, a new key does not.
pub const SCHEMA: &str = "lancer-servers-1";

/// Largest number of servers.
pub const MOST_SERVERS: u32 = 65_536;

/// Most parts of a frame: each is assembled, executed and replayed by itself.
pub const MOST_PARTS: u64 = 16_384;

/// Most numbers of servers at once: each is scheduled for every division.
const MOST_COUNTS: usize = 256;

/// Pattern by which a frame is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, JsonSchema)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[schemars(rename_all = "kebab-case")]
pub enum FrameDivision {
    /// Tiles, dealt out in turn before the frame begins.
    Tiles,
    /// One band of rows a server.
    Rows,
    /// Tiles, of which a server gets the next one when it has sent its last.
    Stealing,
}

/// Home of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, JsonSchema)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[schemars(rename_all = "kebab-case")]
pub enum SceneHome {
    /// Each server has a copy in its own memory, which passes the link ahead of the first frame; pixels pass it as answers.
    Copied,
    /// Scene and frame stay in one memory behind the link, with a door for each server: every transfer of a core passes the link.
    Shared,
}

impl FrameDivision {
    /// All divisions.
    pub const ALL: [FrameDivision; 3] = [FrameDivision::Tiles, FrameDivision::Rows, FrameDivision::Stealing];

    /// Name on command lines and in results.
    pub fn name(self) -> &'static str {
        match self {
            FrameDivision::Tiles => "tiles",
            FrameDivision::Rows => "rows",
            FrameDivision::Stealing => "stealing",
        }
    }

    fn order(self) -> PartOrder {
        match self {
            FrameDivision::Tiles | FrameDivision::Rows => PartOrder::Dealt,
            FrameDivision::Stealing => PartOrder::Stolen,
        }
    }
}

impl SceneHome {
    /// Name on command lines and in results.
    pub fn name(self) -> &'static str {
        match self {
            SceneHome::Copied => "copied",
            SceneHome::Shared => "shared",
        }
    }
}

impl Serialize for FrameDivision {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl Serialize for SceneHome {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// Machines that draw one frame together, as they are asked for.
#[derive(Clone, Debug)]
pub struct ServersPlan {
    /// Numbers of servers.
    pub servers: Vec<u32>,
    /// Divisions of the frame.
    pub divisions: Vec<FrameDivision>,
    /// Widths and heights of tiles in pixels.
    pub tiles: Vec<(u32, u32)>,
    /// Home of the scene.
    pub home: SceneHome,
    /// Link between host and servers.
    pub link: ServerLink,
}

/// A frame on several coprocessors, by division and number of servers.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ServersResult {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// Name of the scene.
    pub scene: String,
    /// Name of the machine that each server is.
    pub machine: String,
    /// Width of the frame in pixels.
    pub width: u32,
    /// Height of the frame in pixels.
    pub height: u32,
    /// Clock rate of the machines and the link in hertz.
    pub clock_hz: u64,
    /// Home of the scene.
    pub home: SceneHome,
    /// Link between host and servers.
    pub link: ServerLink,
    /// Octets of the scene that are copied to a server.
    pub scene_octets: u64,
    /// SHA-256 of the frame, which is the same for all divisions, as in `lancer render --json`.
    pub image_hash: String,
    /// Clocks of the frame on one machine, with nothing divided and no link.
    pub alone_clocks: u64,
    /// Seconds a pixel of that.
    pub alone_pixel_seconds: f64,
    /// The divisions.
    pub curves: Vec<ServersCurve>,
    /// Other machines of the report's table 3, as printed.
    pub table_3: Vec<Peer>,
    /// Time of a pixel on the fastest machine of that table, and how many servers would take no longer.
    pub goal: PixelGoal,
}

/// A division of the frame with several numbers of servers.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ServersCurve {
    /// The division.
    pub division: FrameDivision,
    /// Width and height of a tile in pixels; null for bands of rows.
    pub tile: Option<[u32; 2]>,
    /// One number of servers each, the fewest first.
    pub points: Vec<ServersPoint>,
}

/// A division with one number of servers.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ServersPoint {
    /// Servers. One server draws the frame as a whole, and nothing passes the link.
    pub servers: u32,
    /// Parts of the frame.
    pub parts: u32,
    /// Clocks from the first request to the last answer, the scene being there already.
    pub clocks: u64,
    /// Clocks of the first frame, with the copies of the scene; those of every frame where the scene is shared.
    pub first_clocks: u64,
    /// Seconds of `clocks`.
    pub seconds: f64,
    /// Seconds a pixel.
    pub pixel_seconds: f64,
    /// Speed relative to one server.
    pub speed_up: f64,
    /// Speed-up by the number of servers.
    pub efficiency: f64,
    /// Share of the frame in which the server that draws least draws.
    pub least_busy: f64,
    /// Share of the frame in which servers draw, on average.
    pub mean_busy: f64,
    /// Octets that pass the host's port in a frame; without the transfers of cores where the scene is shared.
    pub port_octets: u64,
    /// Share of the frame in which the port is busy.
    pub port_busy: f64,
    /// Octets that the servers' buses move in a frame.
    pub bus_octets: u64,
    /// Octets a clock that the memory behind the links has to deliver; null where the scene is copied.
    pub shared_octets_per_clock: Option<f64>,
}

impl ServersPlan {
    /// Sizes of the tiles that are drawn: none where nothing but bands is asked for.
    fn tile_sizes(&self) -> &[(u32, u32)] {
        let has_tiles = self.divisions.iter().any(|&division| division != FrameDivision::Rows);
        if has_tiles { &self.tiles } else { &[] }
    }

    /// Numbers of servers that get bands: one server draws the frame as a whole.
    fn band_counts(&self) -> impl Iterator<Item = u32> {
        let has_bands = self.divisions.contains(&FrameDivision::Rows);
        self.servers.iter().copied().filter(move |&servers| has_bands && servers > 1)
    }

    /// Pixels that are drawn altogether for a frame of so many: it is drawn as a whole, once a size of tiles, and once a number of servers that
    /// get bands.
    pub fn pixels(&self, frame: u64) -> u64 {
        frame * (1 + self.tile_sizes().len() + self.band_counts().count()) as u64
    }

    /// Checks that a frame of a size makes no more than [`MOST_PARTS`] parts.
    ///
    /// # Errors
    /// Tiles that are too small, and too many numbers of servers.
    pub fn check(&self, (width, height): (u32, u32)) -> Result<(), Report> {
        let tiles =
            self.tile_sizes().iter().map(|tile| u64::from(width.div_ceil(tile.0)) * u64::from(height.div_ceil(tile.1)));
        let bands = self.band_counts().map(|servers| u64::from(servers.min(height)));
        let parts = tiles.chain(bands).sum::<u64>();
        if parts > MOST_PARTS {
            let message = format!("the divisions of the frame make {parts} parts, and at most {MOST_PARTS} are drawn");
            let hint = "choose larger tiles with --tile, fewer numbers of --servers, or a smaller --size";
            return Err(Diagnostic::error(message).hint(hint).into());
        }
        if self.servers.len() > MOST_COUNTS {
            let message =
                format!("{} numbers of servers are asked for, and at most {MOST_COUNTS} are tried", self.servers.len());
            return Err(Diagnostic::error(message).hint("such as --servers 1,2,4,8").into());
        }
        Ok(())
    }
}

/// The time of a pixel that is to be reached, and what stands in the way.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PixelGoal {
    /// Seconds a pixel, the least of table 3.
    pub pixel_seconds: f64,
    /// Servers that would do if nothing were lost by dividing: the time of one by the goal, rounded up.
    pub ideal_servers: u64,
    /// Fewest servers that reach it with the best division measured; null where none do.
    pub servers: Option<u32>,
    /// Cause that keeps any number of servers from it: `link` (messages alone take longer), `part` (a single part does), `other` (waiting
    /// for both); null where it is reached.
    pub limit: Option<&'static str>,
    /// Least seconds a pixel of any number of servers up to the number of parts, with the best division measured.
    pub least_pixel_seconds: f64,
}

/// Draws a frame on one machine, and in parts on several. `progress` is told of pixels each time some have been drawn, which are
/// [`ServersPlan::pixels`] altogether.
///
/// # Errors
/// Interpolated pixels, whose corners would lie elsewhere in each part; too many parts, as of [`ServersPlan::check`]; and all errors of a picture.
pub fn measure(job: &Job, plan: &ServersPlan, progress: &dyn Fn(u64)) -> Result<ServersResult, Failure> {
    if job.kernels.interpolate.is_some() {
        let message = "a frame with interpolated pixels is not divided: their corners would be others in each part";
        return Err(Failure::usage(Diagnostic::error(message).hint("leave out --interpolate")));
    }
    plan.check(job.kernels.crop.map_or(job.view.size, |crop| (crop.width, crop.height))).map_err(Failure::usage)?;
    let frame = DividedFrame::new(job, plan)?;
    progress(frame.pixels());
    // Tiles of one size are the same for both divisions that have them and for any number of servers; bands are not.
    let drawn = |&tile: &(u32, u32)| Ok((tile, frame.draw(&frame.tiles(tile), progress)?));
    let tiled = plan.tile_sizes().iter().map(drawn).collect::<Result<Vec<_>, Failure>>()?;
    let mut goal = GoalSearch::new(&frame);
    let mut curves = Vec::new();
    for &division in &plan.divisions {
        if division == FrameDivision::Rows {
            let point = |&servers: &u32| {
                // One server draws no band: it has the whole frame.
                let bands = if servers == 1 { Vec::new() } else { frame.bands(servers) };
                Ok(frame.point(servers, &frame.draw(&bands, progress)?, division))
            };
            let points = plan.servers.iter().map(point).collect::<Result<Vec<_>, Failure>>()?;
            curves.push(ServersCurve { division, tile: None, points });
            continue;
        }
        for &((width, height), ref parts) in &tiled {
            goal.search(parts, division.order(), plan.link);
            let points = plan.servers.iter().map(|&servers| frame.point(servers, parts, division)).collect();
            curves.push(ServersCurve { division, tile: Some([width, height]), points });
        }
    }
    let goal = goal.found(&curves);
    Ok(frame.result(curves, goal))
}
