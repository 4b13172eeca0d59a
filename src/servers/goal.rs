//! Search for the number of servers with which a pixel takes no longer than on the fastest machine of table 3.

use super::parts::{DividedFrame, DrawnParts};
use super::{PartOrder, PixelGoal, ServedFrame, ServerLink, ServersCurve, serve};

/// The goal, and what divisions have come to so far.
pub(super) struct GoalSearch {
    /// Seconds a pixel.
    pixel_seconds: f64,
    /// Clocks of a frame at that.
    clocks: f64,
    /// Seconds of a pixel in a frame of one clock.
    scale: f64,
    alone_clocks: u64,
    servers: Option<u32>,
    least_clocks: u64,
    /// Cause that holds up the division with the least clocks.
    limit: &'static str,
}

impl GoalSearch {
    /// The goal for a frame.
    pub fn new(frame: &DividedFrame) -> GoalSearch {
        let least = kernels::annex::peers().iter().map(|peer| peer.pixel_us).fold(f64::INFINITY, f64::min);
        let pixel_seconds = least / 1e6;
        let scale = 1.0 / (frame.clock_hz() as f64 * frame.pixels() as f64);
        let alone_clocks = frame.alone_clocks();
        let clocks = pixel_seconds / scale;
        let servers = (alone_clocks as f64 <= clocks).then_some(1);
        GoalSearch { pixel_seconds, clocks, scale, alone_clocks, servers, least_clocks: alone_clocks, limit: "other" }
    }

    /// Tries as many servers as may reach the goal, at most one a part: more have nothing to do.
    pub fn search(&mut self, parts: &DrawnParts, order: PartOrder, link: ServerLink) {
        let most = parts.costs.len() as u32;
        let on = |servers: u32| serve(&parts.costs, servers, order, link, 0);
        let all = on(most);
        self.note(&all, parts);
        // Fewer servers than this cannot do the work in time, and no number makes the port or a part faster.
        let work: u64 = parts.costs.iter().map(|part| part.clocks).sum();
        let least = (work as f64 / self.clocks).ceil().max(2.0);
        if least > f64::from(most) || all.port_busy.max(longest(parts)) as f64 > self.clocks {
            return;
        }
        let end = self.servers.map_or(most, |servers| most.min(servers - 1));
        for servers in least as u32..=end {
            let frame = on(servers);
            self.note(&frame, parts);
            if frame.clocks as f64 <= self.clocks {
                self.servers = Some(servers);
                return;
            }
        }
    }

    /// Notes the fastest frame, and what its time goes to.
    fn note(&mut self, frame: &ServedFrame, parts: &DrawnParts) {
        if frame.clocks >= self.least_clocks {
            return;
        }
        self.least_clocks = frame.clocks;
        self.limit = match () {
            () if frame.port_busy as f64 > self.clocks => "link",
            () if longest(parts) as f64 > self.clocks => "part",
            () => "other",
        };
    }

    /// The outcome, with what the curves have, too.
    pub fn found(self, curves: &[ServersCurve]) -> PixelGoal {
        let points = || curves.iter().flat_map(|curve| &curve.points);
        let reached = points().filter(|point| point.clocks as f64 <= self.clocks).map(|point| point.servers);
        let servers = reached.chain(self.servers).min();
        let least =
            points().map(|point| point.clocks).min().map_or(self.least_clocks, |own| own.min(self.least_clocks));
        PixelGoal {
            pixel_seconds: self.pixel_seconds,
            ideal_servers: (self.alone_clocks as f64 / self.clocks).ceil() as u64,
            servers,
            limit: servers.is_none().then_some(self.limit),
            least_pixel_seconds: least as f64 * self.scale,
        }
    }
}

/// Clocks of the longest part.
fn longest(parts: &DrawnParts) -> u64 {
    parts.costs.iter().map(|part| part.clocks).max().unwrap_or(0)
}
