//! The variants that a command line asks for, as a study: scenes, machines, kinds of pictures, words and places of the samples are its factors.

use isa::number::Quantization;
use kernels::KernelSet;
use scenes::layout::Layout;
use serde_json::{Value, json};

use super::{BOUNCES, Variant};
use crate::failure::Failure;
use crate::settings::{MachineSettings, Settings};
use crate::sweep::contents::Contents;
use crate::sweep::study::{Assignments, Study};

/// A machine of the variants.
#[derive(Clone, Debug, PartialEq)]
pub struct VariantMachine {
    /// The machine; its word and its rounding are of no account.
    pub machine: MachineSettings,
    /// Words that tell it from the others; empty for the only one.
    pub words: String,
}

/// The values that are tried of each setting. The first one of each list is the base.
#[derive(Clone, Debug)]
pub struct Choices {
    /// Settings that no variant varies.
    pub base: Settings,
    /// Scenes: files, or names of generated ones.
    pub scenes: Vec<String>,
    /// Machines.
    pub machines: Vec<VariantMachine>,
    /// Sets of kernels.
    pub profiles: Vec<KernelSet>,
    /// Bits of a word.
    pub words: Vec<u32>,
    /// Rounding modes.
    pub roundings: Vec<Quantization>,
    /// Layouts.
    pub layouts: Vec<Layout>,
    /// Levels of secondary rays.
    pub bounces: Vec<u32>,
    /// Weights that a secondary ray must exceed.
    pub cutoffs: Vec<f64>,
    /// Differences up to which corners agree; `None` when every pixel has its ray.
    pub interpolate: Vec<Option<f64>>,
    /// Places of the samples beside the shift of all, in pixels to the right and upwards.
    pub shifts: Vec<[f64; 2]>,
}

/// A picture but for scene, machine, word and place of the samples.
#[derive(Clone, Copy, Debug)]
struct VariantKind {
    profile: KernelSet,
    rounding: Quantization,
    layout: Layout,
    bounces: u32,
    cutoff: f64,
    interpolate: Option<f64>,
}

impl VariantKind {
    /// The kind with other kernels, those that were made for a layout in that.
    fn with(&self, profile: KernelSet) -> VariantKind {
        let layout = match profile.layout() {
            own @ (Layout::Report | Layout::Packet | Layout::Packed) => own,
            Layout::Wide => self.layout,
        };
        VariantKind { profile, layout, ..*self }
    }

    fn assignments(&self) -> Assignments {
        let VariantKind { profile, rounding, layout, bounces, cutoff, interpolate } = *self;
        let keys = [
            ("kernels.profile", json!(profile.name())),
            ("layout", json!(layout.name())),
            ("machine.arithmetic.quantization", json!(rounding.name())),
            ("effort.bounces", json!(bounces)),
            ("effort.weight_cutoff", json!(cutoff)),
            ("effort.interpolate", json!(interpolate)),
        ];
        keys.map(|(key, value)| (key.to_owned(), value)).into()
    }
}

impl Choices {
    /// Every profile (that of the report in its own layout), and for each further value of another setting the base profile.
    fn kinds(&self) -> Option<Vec<VariantKind>> {
        let base = VariantKind {
            profile: *self.profiles.first()?,
            rounding: *self.roundings.first()?,
            layout: *self.layouts.first()?,
            bounces: *self.bounces.first()?,
            cutoff: *self.cutoffs.first()?,
            interpolate: *self.interpolate.first()?,
        };
        let mut kinds: Vec<VariantKind> = self.profiles.iter().map(|&profile| base.with(profile)).collect();
        kinds.extend(self.roundings[1..].iter().map(|&rounding| VariantKind { rounding, ..base }));
        kinds.extend(self.layouts[1..].iter().map(|&layout| VariantKind { layout, ..base }));
        kinds.extend(self.bounces[1..].iter().map(|&bounces| VariantKind { bounces, ..base }));
        kinds.extend(self.cutoffs[1..].iter().map(|&cutoff| VariantKind { cutoff, ..base }));
        kinds.extend(self.interpolate[1..].iter().map(|&interpolate| VariantKind { interpolate, ..base }));
        Some(kinds)
    }

    /// Every scene on each machine in every kind and word, at all places of the samples; `None` without a value of some setting.
    pub fn study(&self, name: &str) -> Option<VariantStudy> {
        let one = |key: &str, value: Value| vec![(key.to_owned(), value)];
        let place = |place: &[f64; 2]| json!([0, 1].map(|k| self.base.view.shift[k] + place[k]));
        let factors: [Vec<Assignments>; 5] = [
            self.scenes.iter().map(|scene| one("scene.name", json!(scene))).collect(),
            self.machines.iter().map(|machine| one("machine", machine.machine.brief())).collect(),
            self.kinds()?.iter().map(VariantKind::assignments).collect(),
            self.words.iter().map(|&word| one("machine.arithmetic.word", json!(word))).collect(),
            self.shifts.iter().map(|shift| one("view.shift", place(shift))).collect(),
        ];
        if factors.iter().any(Vec::is_empty) {
            return None;
        }
        // All pictures are measured against one of the same depth, whatever depth they have themselves.
        let mut base = self.base.clone();
        base.results.error = true;
        base.results.reference_bounces.get_or_insert(BOUNCES);
        Some(VariantStudy {
            study: Study { name: name.to_owned(), base: base.value(), factors: factors.into() },
            machine_words: self.machines.iter().map(|machine| machine.words.clone()).collect(),
        })
    }
}

/// Number of a picture among those of [`VariantStudy`]: a scene, a variant and a place of the samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PictureNumber {
    /// Number of the scene.
    pub scene: usize,
    /// Number of the variant: of its machine, its kind and its word, which varies fastest.
    pub variant: usize,
    /// Number of the place of the samples.
    pub shift: usize,
}

/// Points of scenes, machines, kinds, words and places of the samples, which are the factors of the study in this order.
#[derive(Clone, Debug)]
pub struct VariantStudy {
    /// The points.
    pub study: Study,
    machine_words: Vec<String>,
}

impl VariantStudy {
    fn counts(&self) -> [usize; 5] {
        std::array::from_fn(|at| self.study.factors[at].len())
    }

    /// Number of scenes.
    pub fn scenes(&self) -> usize {
        self.counts()[0]
    }

    /// Number of variants of a scene.
    pub fn variants(&self) -> usize {
        self.counts()[1..4].iter().product()
    }

    /// Number of places of the samples.
    pub fn shifts(&self) -> usize {
        self.counts()[4]
    }

    /// Settings of a picture, with what goes by the scene and the hashes of all files.
    ///
    /// # Errors
    /// See [`Study::settings`].
    pub fn settings(&self, number: PictureNumber, contents: &Contents) -> Result<Settings, Failure> {
        let PictureNumber { scene, variant, shift } = number;
        let number = (scene * self.variants() + variant) * self.shifts() + shift;
        self.study.settings(number as u64, contents)
    }

    /// A variant of a scene by its number, with the settings of its first picture.
    ///
    /// # Errors
    /// See [`Study::settings`].
    pub fn variant(&self, scene: usize, variant: usize, contents: &Contents) -> Result<Variant, Failure> {
        let settings = self.settings(PictureNumber { scene, variant, shift: 0 }, contents)?;
        let machine = variant / (self.variants() / self.machine_words.len());
        Ok(Variant { settings, machine_words: self.machine_words[machine].clone() })
    }
}
