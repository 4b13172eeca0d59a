//! Rays of the machine: a pixel's program is run instruction by instruction on a lone core, and what its functions are given and answer is read
//! from the registers that `kernels/asm/registers.inc` names. Nothing is computed a second time here, so kernels of the user's own are explained
//! as they are. Numbers are raw.

use std::collections::HashMap;
use std::ops::Range;

use emu::stepper::{Executed, Stepper};
use isa::Program;
use isa::naming::RegisterId;
use kernels::Function;
use scenes::image::{MemoryImage, MemoryKind};
use scenes::reference::RayKind;

use crate::registers::RegisterContents;
use crate::trace::instruction::instruction;

/// Work of one search for a hit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SearchWork {
    /// Packets that were searched, empty ones included.
    pub packets: u64,
    /// Triangles that were tested.
    pub triangles: u64,
}

/// A triangle that a ray of the machine met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RawHit {
    /// Number of the triangle in the scene.
    pub triangle: u32,
    /// Distance in the format `t`.
    pub t: i32,
}

/// Surface where a ray of the machine met a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RawSurface {
    /// The point, moved off to the side of the ray.
    pub point: [i32; 3],
    /// The point, moved off to the other side.
    pub behind: [i32; 3],
    /// Normal that faces the ray.
    pub facing: [i32; 3],
}

/// A ray of the machine towards a light.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RawShadow {
    /// Number of the light in the scene.
    pub light: u32,
    /// Cosine of the angle between normal and ray, in the format `dir`.
    pub cosine: i32,
    /// Origin and direction of the ray.
    pub ray: [[i32; 3]; 2],
    /// Distance of the light in the format `t`.
    pub distance: i32,
    /// Instructions before its search, and behind it.
    pub steps: Range<u64>,
    /// Effort of its search.
    pub work: SearchWork,
    /// The triangle that was found in its way, the first and not the nearest.
    pub blocker: Option<RawHit>,
}

/// A ray of the machine's ray tree.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RawRay {
    /// Kind of the ray.
    pub kind: RayKind,
    /// Number of the ray whose child it is, in the order in which they are followed.
    pub parent: Option<usize>,
    /// 0 for the camera's ray.
    pub level: u32,
    /// Origin of the ray.
    pub origin: [i32; 3],
    /// Direction of the ray.
    pub direction: [i32; 3],
    /// Weight of the path to it.
    pub weight: i32,
    /// Instructions before its search, and behind the last one that its colour took.
    pub steps: Range<u64>,
    /// The ray meets the scene's box, so that it is searched for a hit; the origin of a camera ray that does not means nothing.
    pub is_searched: bool,
    /// Effort of its search.
    pub work: SearchWork,
    /// The triangle that it met.
    pub hit: Option<RawHit>,
    /// The surface there.
    pub surface: Option<RawSurface>,
    /// Rays towards lights.
    pub shadows: Vec<RawShadow>,
    /// Colour that it brings back, before its weight; `None` where the program did not come to it.
    pub seen: Option<[i32; 3]>,
    /// The pixel's colour after it, and before it.
    pub sums: Option<[[i32; 3]; 2]>,
}

/// Pixel as the machine computed it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RawPixel {
    /// Rays of the ray tree, in the order in which they were followed.
    pub rays: Vec<RawRay>,
    /// The colour that was sent.
    pub colour: Option<[i32; 3]>,
    /// Instructions that were executed.
    pub instructions: u64,
    /// The trap in which the program ended.
    pub trap: Option<String>,
}

/// Triangles that a word tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum TriangleTest {
    /// One.
    One,
    /// As many as its cost says.
    Units,
}

/// Functions that are watched, of those that a core's program has.
const WATCHED: [Function; 6] =
    [Function::Trace, Function::Packet, Function::Triangle, Function::Contribution, Function::Surface, Function::Shade];

/// Labels at which the one loop of the profile `packet` takes up a packet.
const PACKET_LABELS: [&str; 2] = ["search_packet_0", "search_packet_1"];

/// Beginning of a contribution.
#[derive(Clone)]
struct Begun {
    weight: i32,
    /// Colour of the pixel.
    sum: [i32; 3],
    /// The ray, in case it has no search, as one that misses the scene's box has none.
    ray: RawRay,
    /// Rays that there are.
    rays: usize,
}

/// Observer of a pixel's program.
pub struct RayProbe<'a> {
    program: &'a Program,
    image: &'a MemoryImage,
    entries: HashMap<u32, Function>,
    packets: Vec<u32>,
    tests: HashMap<u32, TriangleTest>,
    /// Watched functions that are open, with the number of calls that were open inside of them.
    open: Vec<(Function, usize)>,
    is_shadow: bool,
    begun: Option<Begun>,
    pixel: RawPixel,
}

/// Runs the program of a pixel and reads its rays.
pub fn probe(stepper: &mut Stepper, image: &MemoryImage) -> RawPixel {
    let mut probe = RayProbe::new(stepper, image);
    while stepper.end().is_none() {
        let pc = stepper.code.word(stepper.state().pc);
        probe.before(stepper, pc);
        match stepper.step() {
            Some(executed) => probe.after(stepper, &executed),
            None => break,
        }
    }
    let mut pixel = probe.pixel;
    // The answer is the pixel's number and its colour.
    pixel.colour = stepper.sent().first().and_then(|answer| answer.vectors().get(1)).copied();
    pixel.instructions = stepper.steps();
    pixel.trap = stepper.trap().map(|trap| trap.kind.to_string());
    pixel
}

impl<'a> RayProbe<'a> {
    fn new(stepper: &Stepper<'a>, image: &'a MemoryImage) -> RayProbe<'a> {
        let program = stepper.code.program;
        let place = |name: &str| program.symbols.get(name).and_then(|&at| u32::try_from(at).ok());
        let entries = WATCHED.into_iter().filter_map(|function| Some((place(function.name())?, function)));
        let test = |pc: u32| {
            let instruction = instruction(&stepper.code, pc)?;
            let test = match stepper.code.isa.definition(instruction.op).name.as_ref() {
                "rtri" => TriangleTest::One,
                "rnear" | "rany" => TriangleTest::Units,
                _ => return None,
            };
            Some((pc, test))
        };
        RayProbe {
            program,
            image,
            entries: entries.collect(),
            packets: PACKET_LABELS.into_iter().filter_map(place).collect(),
            tests: (0..program.words.len() as u32).filter_map(test).collect(),
            open: Vec::new(),
            is_shadow: false,
            begun: None,
            pixel: RawPixel::default(),
        }
    }

    /// Before the word at `pc`: a function may begin there.
    fn before(&mut self, stepper: &Stepper, pc: u32) {
        if self.packets.contains(&pc) && self.scalar(stepper, "packet_count") >= 0 {
            self.add_work(1, 0);
        }
        let Some(&function) = self.entries.get(&pc) else { return };
        let depth = stepper.calls().len();
        // A loop that goes back to a function's first word does not begin it again.
        if self.open.last() == Some(&(function, depth)) {
            return;
        }
        self.open.push((function, depth));
        match function {
            Function::Trace => self.begin_search(stepper),
            Function::Packet if self.scalar(stepper, "packet_count") >= 0 => self.add_work(1, 0),
            Function::Triangle => self.add_work(0, 1),
            Function::Contribution => {
                let weight = if self.has_tree() { self.scalar(stepper, "weight_now") } else { self.one() };
                let (ray, rays) = (self.tree_ray(stepper, weight), self.pixel.rays.len());
                self.begun = Some(Begun { weight, sum: self.vector(stepper, "pixel_colour"), ray, rays });
            }
            _ => {}
        }
    }

    /// Behind an instruction: functions may have returned.
    fn after(&mut self, stepper: &Stepper, executed: &Executed) {
        let is_triangle = self.open.last().is_some_and(|(function, _)| *function == Function::Triangle);
        match self.tests.get(&executed.pc) {
            // The function of that name has been counted.
            Some(TriangleTest::One) if !is_triangle => self.add_work(0, 1),
            Some(TriangleTest::Units) => self.add_work(0, u64::from(executed.units)),
            _ => {}
        }
        let calls = stepper.calls().len();
        while let Some(&(function, depth)) = self.open.last()
            && calls < depth
        {
            self.open.pop();
            self.returned(function, stepper);
        }
    }

    fn returned(&mut self, function: Function, stepper: &Stepper) {
        let steps = stepper.steps();
        match function {
            Function::Trace => {
                let near = self.scalar(stepper, "near") as u32;
                let t = self.scalar(stepper, "near_t");
                let hit = self.triangle(near).map(|triangle| RawHit { triangle, t });
                let is_shadow = std::mem::take(&mut self.is_shadow);
                let Some(ray) = self.pixel.rays.last_mut() else { return };
                match ray.shadows.last_mut().filter(|_| is_shadow) {
                    Some(shadow) => (shadow.blocker, shadow.steps.end) = (hit, steps),
                    None => (ray.hit, ray.steps.end) = (hit, steps),
                }
            }
            Function::Surface => {
                let [point, behind, facing] = ["point", "behind", "facing"].map(|name| self.vector(stepper, name));
                if let Some(ray) = self.pixel.rays.last_mut().filter(|ray| ray.surface.is_none()) {
                    ray.surface = Some(RawSurface { point, behind, facing });
                }
            }
            Function::Shade => {
                let seen = self.vector(stepper, "local_colour");
                if let Some(ray) = self.pixel.rays.last_mut() {
                    ray.seen = Some(seen);
                }
            }
            Function::Contribution => {
                let after = self.vector(stepper, "pixel_colour");
                let background = self.image.background;
                let Some(Begun { weight, sum, ray, rays }) = self.begun.take() else { return };
                // The search is part of the contribution, or in the profile `report` comes before it.
                if self.pixel.rays.len() == rays && self.pixel.rays.last().is_none_or(|ray| ray.sums.is_some()) {
                    self.pixel.rays.push(ray);
                }
                let Some(ray) = self.pixel.rays.last_mut() else { return };
                (ray.weight, ray.sums, ray.steps.end) = (weight, Some([after, sum]), steps);
                if ray.hit.is_none() {
                    ray.seen = Some(background);
                }
            }
            _ => {}
        }
    }

    /// A search begins: that of a ray of the ray tree, or of one towards a light.
    fn begin_search(&mut self, stepper: &Stepper) {
        self.is_shadow = self.scalar(stepper, "any_hit") != 0 && !self.pixel.rays.is_empty();
        if self.is_shadow {
            let rays = ["origin", "direction"].map(|name| self.vector(stepper, name));
            let (steps, work) = (stepper.steps()..stepper.steps(), SearchWork::default());
            let light = self.light(stepper);
            let (cosine, distance) = (self.buffered(stepper, "SHADE_COSINE"), self.scalar(stepper, "near_t"));
            let ray = self.pixel.rays.last_mut().expect("a shadow ray belongs to a ray");
            let light = light.unwrap_or(ray.shadows.len() as u32);
            ray.shadows.push(RawShadow { light, cosine, ray: rays, distance, steps, work, blocker: None });
            return;
        }
        let weight = self.begun.as_ref().map_or(0, |begun| begun.weight);
        let is_searched = self.scalar(stepper, "packet_count") >= 0;
        let ray = self.tree_ray(stepper, weight);
        self.pixel.rays.push(RawRay { is_searched, ..ray });
    }

    /// The ray that the walk through the ray tree is at, before its search. The nodes of the profile `report` say level and weight; in the others
    /// `weight` is that of the contribution.
    fn tree_ray(&self, stepper: &Stepper, weight: i32) -> RawRay {
        let [origin, direction] = ["origin", "direction"].map(|name| self.vector(stepper, name));
        let (level, weight) = match (self.node(stepper, "level"), self.node(stepper, "weight")) {
            (Some(level), Some(weight)) => (level as u32 & 0xFF, weight),
            _ if !self.has_tree() => (0, self.one()),
            _ => (self.scalar(stepper, "level") as u32, weight),
        };
        // The walk is depth first, so the parent is the last ray one level up.
        let above = |ray: &RawRay| ray.level + 1 == level;
        let parent = self.pixel.rays.iter().rposition(above);
        let surface = parent.and_then(|parent| self.pixel.rays[parent].surface);
        let kind = match surface {
            None => RayKind::Camera,
            Some(surface) => child_kind(&surface, origin, direction),
        };
        RawRay {
            kind,
            parent,
            level,
            origin,
            direction,
            weight,
            steps: stepper.steps()..stepper.steps(),
            is_searched: false,
            work: SearchWork::default(),
            hit: None,
            surface: None,
            shadows: Vec::new(),
            seen: None,
            sums: None,
        }
    }

    /// Adds to the work of the search that goes on. Kernels of the user's own may test before they search; that belongs to no ray.
    fn add_work(&mut self, packets: u64, triangles: u64) {
        let is_shadow = self.is_shadow;
        let Some(ray) = self.pixel.rays.last_mut() else { return };
        let work = match ray.shadows.last_mut().filter(|_| is_shadow) {
            Some(shadow) => &mut shadow.work,
            None => &mut ray.work,
        };
        work.packets += packets;
        work.triangles += triangles;
    }

    /// The program walks a tree of rays.
    fn has_tree(&self) -> bool {
        self.program.symbols.contains_key(Function::RayTree.name())
    }

    fn one(&self) -> i32 {
        1 << self.image.formats.weight
    }

    /// Number of the triangle at an address of global memory; `None` for 0.
    fn triangle(&self, address: u32) -> Option<u32> {
        let region = self.image.region(MemoryKind::Triangles);
        region.contains(&address).then(|| (address - region.start) / self.image.structures.triangle.octets())
    }

    /// Number of the light that the loop over the lights is at.
    fn light(&self, stepper: &Stepper) -> Option<u32> {
        let [first, step] = ["LIGHTS_AT", "LIGHT_STEP"].map(|name| self.program.symbols.get(name).copied());
        let at = i64::from(self.buffered(stepper, "SHADE_LIGHT"));
        let light = u32::try_from((at - first?).checked_div(step?)?).ok()?;
        (light < self.image.counts.lights).then_some(light)
    }

    /// A word of the buffer by the name of its place; 0 where there is none.
    fn buffered(&self, stepper: &Stepper, name: &str) -> i32 {
        let place = self.program.symbols.get(name).and_then(|&place| u32::try_from(place).ok());
        place.and_then(|place| stepper.state().buffer.word(place).ok()).unwrap_or(0)
    }

    /// A field of the node of the ray tree that the walk of the profile `report` is at.
    fn node(&self, stepper: &Stepper, name: &str) -> Option<i32> {
        let field = self.program.record("treenode")?.fields.iter().find(|field| field.name == name)?;
        let place = (self.scalar(stepper, "node") as u32).checked_add(field.offset)?;
        let octets = stepper.state().buffer.slice(place, field.octets).ok()?;
        Some(octets.iter().rev().fold(0, |word, &octet| word << 8 | i32::from(octet)))
    }

    fn register(&self, stepper: &Stepper, name: &str) -> Option<RegisterContents> {
        let register: RegisterId = self.program.register_named(name, stepper.code.word(stepper.state().pc))?;
        Some(RegisterContents::of(&stepper.state().registers, register))
    }

    fn scalar(&self, stepper: &Stepper, name: &str) -> i32 {
        match self.register(stepper, name) {
            Some(RegisterContents::One(value)) => value as i32,
            _ => 0,
        }
    }

    fn vector(&self, stepper: &Stepper, name: &str) -> [i32; 3] {
        match self.register(stepper, name) {
            Some(RegisterContents::Three(value)) => value,
            _ => [0; 3],
        }
    }
}

/// Kind of a child by the side of its parent's surface on which it starts, or where both are one point by its direction.
fn child_kind(surface: &RawSurface, origin: [i32; 3], direction: [i32; 3]) -> RayKind {
    let along = |k: usize| i64::from(direction[k]).saturating_mul(i64::from(surface.facing[k])) >> 2;
    let is_behind = match (origin == surface.point, origin == surface.behind) {
        (true, false) => false,
        (false, true) => true,
        _ => (0..3).map(along).sum::<i64>() < 0,
    };
    if is_behind { RayKind::Refracted } else { RayKind::Reflected }
}
