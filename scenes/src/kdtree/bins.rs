//! Planes found by bins: a node's axes in equal parts, with the numbers of bounds in each, so that the neighbourhood of the best plane is known before
//! anything is sorted (Popov et al. 2006, Shevtsov et al. 2007). How a node is divided by its plane is not said here.
//!
//! Costs are those of [`super::split`] in double precision, which is exact enough to choose by and the same on every host.

use super::Bounds;
use super::membership::Part;
use super::split::{Division, Side, Sweep};

/// Triangles of a large node that are looked at, at least: every second, third and so on is left out as long as so many remain.
const SAMPLE: usize = 2048;

/// Search for planes, with storage that serves one node after another.
#[derive(Default)]
pub(super) struct PlaneSearch {
    lows: Vec<i32>,
    highs: Vec<i32>,
    flats: Vec<i32>,
    sweep: Sweep,
}

impl PlaneSearch {
    /// A good plane of a node; `None` when no plane pays.
    pub(super) fn plane(&mut self, node: &Bounds, packet: &[Part]) -> Option<Division> {
        let found = match packet.len() {
            0 | 1 => return None,
            2..=4 => return best_of_few::<4>(node, packet),
            5..=8 => return best_of_few::<8>(node, packet),
            9..64 => self.near_cheapest::<8>(node, packet, 1),
            64..256 => self.near_cheapest::<16>(node, packet, 1),
            count => self.near_cheapest::<32>(node, packet, (count / SAMPLE).max(1)),
        };
        // It is rare that none pays there, and only then are all bounds sorted.
        found.or_else(|| {
            let parts = || packet.iter().map(|part| &part.bounds);
            let candidates = (0..3).filter_map(|axis| self.sweep.best(node, axis, parts()));
            candidates.min_by_key(|(_, cost)| *cost).map(|(division, _)| division)
        })
    }

    /// The best plane among the bounds in two bins, those on both sides of the cheapest start of a bin.
    fn near_cheapest<const N: usize>(&mut self, node: &Bounds, packet: &[Part], stride: usize) -> Option<Division> {
        let bins = Bins::<N>::new(node, packet.iter().step_by(stride));
        let Cheapest { axis, bin, mut left, mut right } = bins.cheapest(node);
        let place = bins.places[axis];
        let is_near = |at: i32| place.bin(at).wrapping_sub(bin - 1) < 2;
        let PlaneSearch { lows, highs, flats, .. } = self;
        for list in [&mut *lows, highs, flats] {
            list.clear();
        }
        for part in packet.iter().step_by(stride) {
            let (low, high) = (part.bounds.low[axis], part.bounds.high[axis]);
            if is_near(low) {
                lows.push(low);
                flats.extend((low == high).then_some(low));
            }
            if is_near(high) {
                highs.push(high);
            }
        }
        for list in [&mut *lows, highs, flats] {
            list.sort_unstable();
        }
        let slice = ChildCosts::new(node, axis);
        let mut lowest = slice.undivided(bins.count);
        let mut found = None;
        let (mut lows, mut highs, mut flats) =
            (lows.iter().peekable(), highs.iter().peekable(), flats.iter().peekable());
        while let Some(&at) = [lows.peek(), highs.peek()].into_iter().flatten().min() {
            let at = *at;
            // Lower bounds at the plane are behind it and upper ones in front of it, but for triangles in the plane, which are on one side only.
            let starting = equal(&mut lows, at);
            right -= equal(&mut highs, at);
            if at > node.low[axis] && at < node.high[axis] {
                let length = f64::from(at) - slice.low;
                let flat = equal(&mut flats, at);
                let cost = slice.cost_at(length, [left as i32, right as i32]) + slice.smaller(length) * f64::from(flat);
                if cost < lowest {
                    lowest = cost;
                    found = Some(slice.division(at));
                }
            }
            left += starting;
        }
        found
    }
}

/// Takes the leading bounds that equal `at`, and counts them; those before it are taken, too.
fn equal<'a>(bounds: &mut std::iter::Peekable<impl Iterator<Item = &'a i32>>, at: i32) -> u32 {
    let mut count = 0;
    while let Some(&bound) = bounds.next_if(|&&bound| bound <= at) {
        count += u32::from(bound == at);
    }
    count
}

/// Numbers of the bounds of a node's triangles in each part of each axis.
struct Bins<const N: usize> {
    places: [AxisBins; 3],
    lows: [[u32; N]; 3],
    highs: [[u32; N]; 3],
    /// Triangles that were counted.
    count: u32,
}

/// The cheapest start of a bin.
struct Cheapest {
    axis: usize,
    /// The bin that begins there, 1 or more.
    bin: usize,
    /// Lower bounds before the bin in front of it.
    left: u32,
    /// Upper bounds in the bin in front of it and behind.
    right: u32,
}

/// An axis of a node in equal parts.
#[derive(Clone, Copy)]
struct AxisBins {
    low: i32,
    /// Parts in a unit, with 32 fraction bits.
    scale: u64,
}

impl AxisBins {
    fn new(node: &Bounds, axis: usize, parts: usize) -> AxisBins {
        AxisBins { low: node.low[axis], scale: ((parts as u64) << 32) / (u64::from(node.side(axis)) + 1) }
    }

    /// The part of a coordinate inside the node. In a node from 0 to 99 in 32 parts a unit is 0.32 parts, so 50 lies in part 16.
    fn bin(self, at: i32) -> usize {
        ((u64::from(at.abs_diff(self.low)) * self.scale) >> 32) as usize
    }
}

impl<const N: usize> Bins<N> {
    fn new<'a>(node: &Bounds, packet: impl Iterator<Item = &'a Part>) -> Bins<N> {
        let places = [0, 1, 2].map(|axis| AxisBins::new(node, axis, N));
        let mut bins = Bins { places, lows: [[0; N]; 3], highs: [[0; N]; 3], count: 0 };
        for part in packet {
            for (axis, place) in places.iter().enumerate() {
                bins.lows[axis][place.bin(part.bounds.low[axis])] += 1;
                bins.highs[axis][place.bin(part.bounds.high[axis])] += 1;
            }
            bins.count += 1;
        }
        bins
    }

    /// The start of a bin that is the cheapest plane of all starts; of equal ones the first.
    fn cheapest(&self, node: &Bounds) -> Cheapest {
        let mut lowest = f64::INFINITY;
        let mut cheapest = Cheapest { axis: 0, bin: 1, left: 0, right: self.count };
        for axis in 0..3 {
            let slice = ChildCosts::new(node, axis);
            let part = f64::from(node.side(axis)) / N as f64;
            let (mut left, mut right) = (0, self.count);
            for bin in 1..N {
                let before = (left, right);
                left += self.lows[axis][bin - 1];
                right -= self.highs[axis][bin - 1];
                let cost = slice.cost_at(part * bin as f64, [left as i32, right as i32]);
                if cost < lowest {
                    lowest = cost;
                    cheapest = Cheapest { axis, bin, left: before.0, right: before.1 };
                }
            }
        }
        cheapest
    }
}

/// Costs of the planes of a node across an axis. Half the surface of a child is linear in its length along the axis.
struct ChildCosts {
    axis: usize,
    /// Lower face of the node.
    low: f64,
    /// Length of the node.
    side: f64,
    /// Surface per unit of length.
    slope: f64,
    /// Surface at length 0: one face across the axis.
    face: f64,
}

impl ChildCosts {
    fn new(node: &Bounds, axis: usize) -> ChildCosts {
        let [a, b] = [(axis + 1) % 3, (axis + 2) % 3].map(|other| f64::from(node.side(other)));
        ChildCosts { axis, low: node.low[axis].into(), side: f64::from(node.side(axis)), slope: a + b, face: a * b }
    }

    /// Cost above which a plane does not pay: a visit of the node costs as much as a triangle.
    fn undivided(&self, count: u32) -> f64 {
        (self.slope * self.side + self.face) * (f64::from(count) - 1.0)
    }

    /// Cost of a plane `length` units above the node's lower face, with so many triangles left and right of it and in it.
    #[inline]
    fn cost_at(&self, length: f64, [left, right]: [i32; 2]) -> f64 {
        let lower = self.slope * length + self.face;
        let upper = self.slope * (self.side - length) + self.face;
        lower * f64::from(left) + upper * f64::from(right)
    }

    /// Surface of the smaller child of a plane.
    #[inline]
    fn smaller(&self, length: f64) -> f64 {
        let lower = self.slope * length + self.face;
        let upper = self.slope * (self.side - length) + self.face;
        if upper < lower { upper } else { lower }
    }

    /// Costs of planes at which none of the triangles lies flat.
    #[inline]
    fn costs<const N: usize>(&self, lows: &[i32; N], highs: &[i32; N], planes: &[i32; TOGETHER]) -> [f64; TOGETHER] {
        let [mut left, mut right] = [[0; TOGETHER]; 2];
        for j in 0..N {
            for k in 0..TOGETHER {
                left[k] += i32::from(lows[j] < planes[k]);
                right[k] += i32::from(highs[j] > planes[k]);
            }
        }
        let mut costs = [0.0; TOGETHER];
        for k in 0..TOGETHER {
            costs[k] = self.cost_at(f64::from(planes[k]) - self.low, [left[k], right[k]]);
        }
        costs
    }

    /// Adds the costs of triangles that lie in planes.
    fn add_flats(&self, lows: &[i32], highs: &[i32], planes: &[i32; TOGETHER], costs: &mut [f64; TOGETHER]) {
        for (cost, &at) in costs.iter_mut().zip(planes) {
            let flat = lows.iter().zip(highs).filter(|&(&low, &high)| low == at && high == at).count();
            *cost += self.smaller(f64::from(at) - self.low) * flat as f64;
        }
    }

    /// The plane, with the triangles in it on its smaller side.
    fn division(&self, at: i32) -> Division {
        let length = f64::from(at) - self.low;
        let flat = if self.side - length < length { Side::Right } else { Side::Left };
        Division { axis: self.axis, at, flat }
    }
}

/// Planes whose costs are computed together.
const TOGETHER: usize = 4;

/// Most planes along an axis of a node that is searched without sorting: two a triangle.
const FEW_PLANES: usize = 16;

/// The best plane of a node that holds at most `N` triangles: nothing is sorted, each plane is compared with each bound, [`TOGETHER`] at a time.
fn best_of_few<const N: usize>(node: &Bounds, packet: &[Part]) -> Option<Division> {
    const { assert!(2 * N <= FEW_PLANES) };
    let mut lowest = ChildCosts::new(node, 0).undivided(packet.len() as u32);
    let mut found = None;
    for axis in 0..3 {
        // Places that no triangle takes are on neither side of any plane.
        let (mut lows, mut highs) = ([i32::MAX; N], [i32::MIN; N]);
        for (k, part) in packet.iter().enumerate().take(N) {
            (lows[k], highs[k]) = (part.bounds.low[axis], part.bounds.high[axis]);
        }
        // Most bounds are in a face of the node, where no plane is. The others stand in front, lower bounds first.
        let mut planes = [node.low[axis]; FEW_PLANES];
        let mut count = 0;
        for list in [&lows, &highs] {
            for &at in &list[..packet.len()] {
                planes[count % FEW_PLANES] = at;
                count += usize::from(at > node.low[axis] && at < node.high[axis]);
            }
        }
        let has_flat = lows.iter().zip(&highs).any(|(low, high)| low == high);
        let slice = ChildCosts::new(node, axis);
        for planes in planes[..count].chunks(TOGETHER) {
            let mut group = [node.low[axis]; TOGETHER];
            group[..planes.len()].copy_from_slice(planes);
            let mut costs = slice.costs(&lows, &highs, &group);
            if has_flat {
                slice.add_flats(&lows, &highs, &group, &mut costs);
            }
            for (&cost, &at) in costs.iter().zip(planes) {
                if cost < lowest {
                    lowest = cost;
                    found = Some(slice.division(at));
                }
            }
        }
    }
    found
}
