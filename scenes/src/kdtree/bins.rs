//! Planes found by bins: a node's axes in equal parts, with the numbers of bounds in each, so that the neighbourhood of the best plane is known before
//! anything is sorted (Popov et al. 2006, Shevtsov et al. 2007). How a node is divided by its plane is not said here.
//!
//! Costs are those of [`super::split`] in double precision, which is exact enough to choose by and the same on every host.

use std::ops::Range;

use wide::{f64x4, i32x4};

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
    /// A good plane of a node, in which all of the parts lie, where a visit costs `visit` tests, at most 1; `None` when no plane pays.
    pub(super) fn plane(&mut self, node: &Bounds, packet: &[Part], visit: f64) -> Option<Division> {
        let found = match packet.len() {
            0 | 1 => return None,
            2..=4 => return best_of_few::<4>(node, packet, visit),
            5..=8 => return best_of_few::<8>(node, packet, visit),
            9..64 => self.near_cheapest::<8>(node, packet.iter(), visit),
            64..256 => self.near_cheapest::<16>(node, packet.iter(), visit),
            count if count < 2 * SAMPLE => self.near_cheapest::<32>(node, packet.iter(), visit),
            count => self.near_cheapest::<32>(node, packet.iter().step_by(count / SAMPLE), visit),
        };
        // It is rare that none pays there, and only then are all bounds sorted.
        found.or_else(|| {
            let parts = || packet.iter().map(|part| &part.bounds);
            let candidates = (0..3).filter_map(|axis| self.sweep.best(node, axis, parts()));
            candidates.min_by_key(|(_, cost)| *cost).map(|(division, _)| division)
        })
    }

    /// The best plane among the bounds in two bins, those on both sides of the cheapest start of a bin.
    fn near_cheapest<'a, const N: usize>(
        &mut self,
        node: &Bounds,
        packet: impl ExactSizeIterator<Item = &'a Part> + Clone,
        visit: f64,
    ) -> Option<Division> {
        let bins = Bins::<N>::new(node, packet.clone());
        let Cheapest { axis, bin, mut left, mut right } = bins.cheapest(node);
        self.gather(node, axis, bins.places[axis].two_bins(bin), packet);
        let PlaneSearch { lows, highs, flats, .. } = self;
        let slice = ChildCosts::new(node, axis);
        let mut lowest = slice.undivided(bins.count, visit);
        let mut found = None;
        let [mut low, mut high, mut flat] = [0; 3];
        loop {
            // The lists end with a number that is no plane of any node.
            let at = lows[low].min(highs[high]);
            if at >= node.high[axis] {
                return found;
            }
            // Lower bounds at the plane are behind it and upper ones in front of it, but for triangles in the plane, which are on one side only.
            let [starting, ending] = [run(lows, &mut low, at), run(highs, &mut high, at)];
            right -= ending;
            if at > node.low[axis] {
                while flats[flat] < at {
                    flat += 1;
                }
                let length = f64::from(at) - slice.low;
                let in_plane = f64::from(run(flats, &mut flat, at));
                let cost = slice.cost_at(length, [left as i32, right as i32]) + slice.smaller(length) * in_plane;
                if cost < lowest {
                    lowest = cost;
                    found = Some(slice.division(at));
                }
            }
            left += starting;
        }
    }

    /// Fills the lists with the bounds in a range of distances from the node's lower face, each list sorted and with [`i32::MAX`] at its end.
    fn gather<'a>(
        &mut self,
        node: &Bounds,
        axis: usize,
        Range { start, end }: Range<u64>,
        packet: impl ExactSizeIterator<Item = &'a Part> + Clone,
    ) {
        let PlaneSearch { lows, highs, flats, .. } = self;
        let most = packet.len() + 1;
        for list in [&mut *lows, highs] {
            list.resize(most.max(list.len()), 0);
        }
        let is_near = |at: i32| distance(node.low[axis], at).wrapping_sub(start) < end - start;
        let [mut low_count, mut high_count, mut flat_count] = [0; 3];
        // Each bound is written, but only those that are near make a list longer: which are, no branch can foresee.
        for part in packet.clone() {
            let (low, high) = (part.bounds.low[axis], part.bounds.high[axis]);
            (lows[low_count], highs[high_count]) = (low, high);
            low_count += usize::from(is_near(low));
            high_count += usize::from(is_near(high));
            flat_count += usize::from(low == high);
        }
        flats.clear();
        if flat_count > 0 {
            let flat = packet.map(|part| (part.bounds.low[axis], part.bounds.high[axis]));
            flats.extend(flat.filter(|(low, high)| low == high && is_near(*low)).map(|(low, _)| low));
            flats.sort_unstable();
        }
        flats.push(i32::MAX);
        for (list, count) in [(lows, low_count), (highs, high_count)] {
            list[..count].sort_unstable();
            list[count] = i32::MAX;
        }
    }
}

/// Steps over the bounds that equal `at`, and counts them.
#[inline]
fn run(bounds: &[i32], place: &mut usize, at: i32) -> u32 {
    let before = *place;
    while bounds[*place] == at {
        *place += 1;
    }
    (*place - before) as u32
}

/// Distance of a coordinate from a face that is not above it.
#[inline]
fn distance(face: i32, at: i32) -> u64 {
    u64::from(at.wrapping_sub(face) as u32)
}

/// Numbers of the bounds of a node's triangles in each part of each axis.
struct Bins<const N: usize> {
    places: [AxisBins; 3],
    /// Bin by bin, three axes and a place that stays 0, so that all of them are computed together.
    lows: [[i32; 4]; N],
    highs: [[i32; 4]; N],
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
    #[inline]
    fn bin(self, at: i32) -> usize {
        ((distance(self.low, at) * self.scale) >> 32) as usize
    }

    /// Distances from the lower face of the coordinates in a bin and in the one in front of it. In the node above, those of bins 15 and 16 are 47 to 53:
    /// 15 / 0.32 is 46.9, 17 / 0.32 is 53.1.
    fn two_bins(self, bin: usize) -> Range<u64> {
        let start = |bin: usize| ((bin as u64) << 32).div_ceil(self.scale);
        start(bin - 1)..start(bin + 1)
    }
}

impl<const N: usize> Bins<N> {
    fn new<'a>(node: &Bounds, packet: impl ExactSizeIterator<Item = &'a Part>) -> Bins<N> {
        const { assert!(N.is_power_of_two()) };
        let places = [0, 1, 2].map(|axis| AxisBins::new(node, axis, N));
        let mut bins = Bins { places, lows: [[0; 4]; N], highs: [[0; 4]; N], count: packet.len() as u32 };
        for part in packet {
            for (axis, place) in places.iter().enumerate() {
                // The remainder changes nothing, and needs no branch as a check of the index would.
                bins.lows[place.bin(part.bounds.low[axis]) % N][axis] += 1;
                bins.highs[place.bin(part.bounds.high[axis]) % N][axis] += 1;
            }
        }
        bins
    }

    /// The start of a bin that is the cheapest plane of all starts; of equal ones the first, axis by axis.
    fn cheapest(&self, node: &Bounds) -> Cheapest {
        // All axes at once. The fourth place is one of a node without surface, whose costs are 0 and not looked at.
        let slices = [0, 1, 2].map(|axis| ChildCosts::new(node, axis));
        let lanes = |of: fn(&ChildCosts) -> f64| f64x4::new([of(&slices[0]), of(&slices[1]), of(&slices[2]), 0.0]);
        let (side, slope, face) = (lanes(|slice| slice.side), lanes(|slice| slice.slope), lanes(|slice| slice.face));
        let part = side * f64x4::splat(1.0 / N as f64);
        let (mut left, mut right) = (i32x4::ZERO, i32x4::splat(self.count as i32));
        let (mut lowest, mut cheapest) = (f64x4::splat(f64::INFINITY), f64x4::ONE);
        for bin in 1..N {
            left += i32x4::new(self.lows[bin - 1]);
            right -= i32x4::new(self.highs[bin - 1]);
            let number = f64x4::splat(bin as f64);
            let length = part * number;
            let (lower, upper) = (slope * length + face, slope * (side - length) + face);
            let cost = lower * f64x4::from_i32x4(left) + upper * f64x4::from_i32x4(right);
            let is_lower = cost.simd_lt(lowest);
            lowest = is_lower.select(cost, lowest);
            cheapest = is_lower.select(number, cheapest);
        }
        let lowest = lowest.to_array();
        let axis = (1..3).fold(0, |best, axis| if lowest[axis] < lowest[best] { axis } else { best });
        let bin = cheapest.to_array()[axis] as usize;
        let before = |counts: &[[i32; 4]; N]| counts.iter().take(bin - 1).map(|axes| axes[axis] as u32).sum::<u32>();
        Cheapest { axis, bin, left: before(&self.lows), right: self.count - before(&self.highs) }
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

    /// Cost above which a plane does not pay: a visit of the node costs as much as `visit` triangles.
    fn undivided(&self, count: u32, visit: f64) -> f64 {
        (self.slope * self.side + self.face) * (f64::from(count) - visit)
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

    /// Costs of some planes of a node with at most `N` triangles; `HAS_FLAT` is false if none of them lies in a plane across the axis.
    #[inline]
    fn costs<const N: usize, const HAS_FLAT: bool>(&self, lows: &[i32; N], highs: &[i32; N], planes: i32x4) -> f64x4 {
        let [mut left, mut right, mut flat] = [i32x4::ZERO; 3];
        for (&low, &high) in lows.iter().zip(highs) {
            // What holds is -1.
            left -= i32x4::splat(low).simd_lt(planes);
            right -= i32x4::splat(high).simd_gt(planes);
            if HAS_FLAT && low == high {
                flat -= i32x4::splat(low).simd_eq(planes);
            }
        }
        let [slope, face] = [self.slope, self.face].map(f64x4::splat);
        let length = f64x4::from_i32x4(planes) - f64x4::splat(self.low);
        let (lower, upper) = (slope * length + face, slope * (f64x4::splat(self.side) - length) + face);
        let costs = lower * f64x4::from_i32x4(left) + upper * f64x4::from_i32x4(right);
        if HAS_FLAT { costs + lower.fast_min(upper) * f64x4::from_i32x4(flat) } else { costs }
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

/// The best plane of a node that holds at most `N` triangles, of equal ones the first axis by axis, lower bounds first: nothing is sorted, each plane is
/// compared with each bound, [`TOGETHER`] at a time.
fn best_of_few<const N: usize>(node: &Bounds, packet: &[Part], visit: f64) -> Option<Division> {
    const { assert!(2 * N <= FEW_PLANES) };
    let slices = [0, 1, 2].map(|axis| ChildCosts::new(node, axis));
    let undivided = slices[0].undivided(packet.len() as u32, visit);
    // The lowest costs so far in each place of a group, and the numbers of the planes that have them.
    let (mut lowest, mut cheapest) = (f64x4::splat(undivided), f64x4::ZERO);
    let mut planes = [[0; FEW_PLANES]; 3];
    for (axis, (slice, planes)) in slices.iter().zip(&mut planes).enumerate() {
        // Places that no triangle takes are on neither side of any plane.
        let (mut lows, mut highs) = ([i32::MAX; N], [i32::MIN; N]);
        for (k, part) in packet.iter().enumerate().take(N) {
            (lows[k], highs[k]) = (part.bounds.low[axis], part.bounds.high[axis]);
        }
        // Most bounds are in a face of the node, where no plane is. The others stand in front, lower bounds first.
        let mut count = 0;
        for list in [&lows, &highs] {
            for &at in &list[..packet.len()] {
                planes[count % FEW_PLANES] = at;
                count += usize::from((at > node.low[axis]) & (at < node.high[axis]));
            }
        }
        let has_flat = lows.iter().zip(&highs).any(|(low, high)| low == high);
        for (number, group) in planes[..count].chunks(TOGETHER).enumerate() {
            // The first one once more where a group is not full: what stands first is taken.
            let mut full = [group[0]; TOGETHER];
            full[..group.len()].copy_from_slice(group);
            let planes = i32x4::new(full);
            let costs = match has_flat {
                true => slice.costs::<N, true>(&lows, &highs, planes),
                false => slice.costs::<N, false>(&lows, &highs, planes),
            };
            let first = (axis * FEW_PLANES + number * TOGETHER) as f64;
            let is_lower = costs.simd_lt(lowest);
            lowest = is_lower.select(costs, lowest);
            cheapest = is_lower.select(f64x4::new([first, first + 1.0, first + 2.0, first + 3.0]), cheapest);
        }
    }
    let (lowest, cheapest) = (lowest.to_array(), cheapest.to_array());
    let best = (1..TOGETHER).fold(0, |best, place| {
        let is_better = (lowest[place], cheapest[place]) < (lowest[best], cheapest[best]);
        if is_better { place } else { best }
    });
    let number = cheapest[best] as usize;
    let axis = number / FEW_PLANES % 3;
    (lowest[best] < undivided).then(|| slices[axis].division(planes[axis][number % FEW_PLANES]))
}
