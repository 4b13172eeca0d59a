//! Parts of a frame on several coprocessors, over one port of the host: an exact schedule, event by event.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};

use schemars::JsonSchema;
use serde::Serialize;

/// Octets of a message that asks for a part of a frame: its column, row, width and height, 4 octets each. A message that a part is done has
/// as many.
pub const MESSAGE: u64 = 16;

/// Link between the host and each server. All links meet in one port of the host, which passes one message at a time, in either direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct ServerLink {
    /// Latency: clocks from the end of a message at the port to its being there.
    pub latency_clocks: u64,
    /// Octets that pass the port in a clock.
    pub octets_per_clock: u64,
}

/// A part of a frame as a work for a server.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PartCost {
    /// Clocks on a server's machine.
    pub clocks: u64,
    /// Octets of the answer.
    pub answer: u64,
}

/// Rule by which parts come to servers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartOrder {
    /// Part `i` belongs to server `i % N`, which is told of all its parts at once.
    Dealt,
    /// A server gets the next part when the answer to its last one has arrived.
    Stolen,
}

/// A frame on several servers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ServedFrame {
    /// Clocks until the last answer has arrived.
    pub clocks: u64,
    /// Clocks in which each server drew that had any part.
    pub busy: Vec<u64>,
    /// Clocks in which the port passed messages.
    pub port_busy: u64,
    /// Octets that passed the port.
    pub octets: u64,
}

/// The host's port.
#[derive(Default)]
struct HostPort {
    free: u64,
    busy: u64,
    octets: u64,
}

impl HostPort {
    /// Passes a message that is ready at a time, after those of before; the clock at which it has arrived.
    fn pass(&mut self, ready: u64, octets: u64, link: ServerLink) -> u64 {
        let clocks = octets.div_ceil(link.octets_per_clock);
        self.free = self.free.max(ready) + clocks;
        self.busy += clocks;
        self.octets += octets;
        self.free + link.latency_clocks
    }
}

/// Next thing that happens to a server. At one clock answers of lower servers come first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum ServerEvent {
    /// The server has drawn a part.
    Drawn { part: usize },
    /// The host has its answer.
    Answered,
}

/// Schedules the parts of a frame on `servers` servers, each of which draws one part at a time. `scene` octets go to each server that draws
/// anything, ahead of its first part; 0 where the scene is there already.
///
/// For example two parts of 100 clocks with answers of 40 octets on two servers, a latency of 10 clocks, 4 octets a clock, no scene: the first
/// request passes the port in 4 clocks and arrives at 14, the second at 18; the parts are drawn at 114 and 118; the answers pass the port from
/// 114 to 124 and from 124 to 134, so the frame takes 144 clocks.
pub fn serve(parts: &[PartCost], servers: u32, order: PartOrder, link: ServerLink, scene: u64) -> ServedFrame {
    // More servers than parts have nothing to do.
    let servers = parts.len().min(servers as usize);
    let mut port = HostPort::default();
    let mut frame = ServedFrame { busy: vec![0; servers], ..ServedFrame::default() };
    // Parts that wait: for whoever comes first, or for their server.
    let mut queues: Vec<VecDeque<usize>> = match order {
        PartOrder::Stolen => vec![(0..parts.len()).collect()],
        PartOrder::Dealt => {
            let own = |server: usize| (server..parts.len()).step_by(servers).collect();
            (0..servers).map(own).collect()
        }
    };
    let queue_of = |server: usize| if order == PartOrder::Stolen { 0 } else { server };
    // First requests go out in the order of the servers.
    let mut events = BinaryHeap::new();
    for server in 0..servers {
        let queue = &mut queues[queue_of(server)];
        let asked = if order == PartOrder::Stolen { queue.len().min(1) } else { queue.len() };
        let Some(part) = queue.pop_front() else { continue };
        let arrival = port.pass(0, scene + MESSAGE * asked as u64, link);
        events.push(Reverse((arrival + parts[part].clocks, server, ServerEvent::Drawn { part })));
    }
    // Later messages pass the port in the order in which they are ready, because events come in the order of time.
    while let Some(Reverse((now, server, event))) = events.pop() {
        let mut answered = None;
        if let ServerEvent::Drawn { part } = event {
            frame.busy[server] += parts[part].clocks;
            let arrival = port.pass(now, parts[part].answer, link);
            frame.clocks = frame.clocks.max(arrival);
            answered = Some(arrival);
        }
        match (order, answered) {
            (PartOrder::Stolen, Some(arrival)) => events.push(Reverse((arrival, server, ServerEvent::Answered))),
            (PartOrder::Stolen, None) => {
                let Some(part) = queues[0].pop_front() else { continue };
                let arrival = port.pass(now, MESSAGE, link);
                events.push(Reverse((arrival + parts[part].clocks, server, ServerEvent::Drawn { part })));
            }
            (PartOrder::Dealt, _) => {
                let Some(part) = queues[server].pop_front() else { continue };
                events.push(Reverse((now + parts[part].clocks, server, ServerEvent::Drawn { part })));
            }
        }
    }
    (frame.port_busy, frame.octets) = (port.busy, port.octets);
    frame
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINK: ServerLink = ServerLink { latency_clocks: 10, octets_per_clock: 4 };

    fn parts(clocks: &[u64]) -> Vec<PartCost> {
        clocks.iter().map(|&clocks| PartCost { clocks, answer: 40 }).collect()
    }

    #[test]
    fn frames_by_hand() {
        let clocks = |parts: &[PartCost], servers, order, scene| serve(parts, servers, order, LINK, scene).clocks;
        let two = parts(&[100, 100]);
        for order in [PartOrder::Dealt, PartOrder::Stolen] {
            // The example of the function.
            assert_eq!(clocks(&two, 2, order, 0), 144);
            // A scene of 400 octets takes the port 100 clocks a server: the second is asked at 218, and both answers pass apart.
            assert_eq!(clocks(&two, 2, order, 400), 218 + 100 + 10 + 10);
            // A third server has nothing to do and gets nothing.
            assert_eq!(serve(&two, 3, order, LINK, 400).octets, 2 * (400 + MESSAGE + 40));
        }
        // One server that is told of both parts at once has them at 18 and draws without a pause; the second answer is there at 218 + 20.
        assert_eq!(clocks(&two, 1, PartOrder::Dealt, 0), 238);
        // One that asks anew: answered at 14 + 100 + 20, asked again at 134 + 14, drawn at 248, answered at 268.
        assert_eq!(clocks(&two, 1, PartOrder::Stolen, 0), 268);
        // A long part first: dealing gives its server a second one, the other server would have time.
        let uneven = parts(&[1000, 10, 10]);
        assert_eq!(serve(&uneven, 2, PartOrder::Dealt, LINK, 0).busy, [1010, 10]);
        assert_eq!(serve(&uneven, 2, PartOrder::Stolen, LINK, 0).busy, [1000, 20]);
    }

    #[test]
    fn nothing_is_lost_and_nothing_is_faster_than_its_parts() {
        let mut random = random::SplitMix64::new(11);
        for _ in 0..500 {
            let count = 1 + random.below(30) as usize;
            let all: Vec<PartCost> =
                (0..count).map(|_| PartCost { clocks: random.below(5000), answer: random.below(3000) }).collect();
            let servers = 1 + random.below(12) as u32;
            let scene = random.below(2) * random.below(10_000);
            for order in [PartOrder::Dealt, PartOrder::Stolen] {
                let frame = serve(&all, servers, order, LINK, scene);
                let (work, answers): (u64, u64) =
                    (all.iter().map(|part| part.clocks).sum(), all.iter().map(|part| part.answer).sum());
                let used = u64::from(servers).min(count as u64);
                assert_eq!(frame.busy.iter().sum::<u64>(), work);
                assert_eq!(frame.octets, answers + MESSAGE * count as u64 + scene * used);
                let longest = all.iter().map(|part| part.clocks).max().unwrap_or(0);
                let least = longest.max(work.div_ceil(u64::from(servers))).max(frame.port_busy);
                assert!(frame.clocks >= least, "{frame:?}");
            }
        }
    }
}
