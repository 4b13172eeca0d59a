//! Results of a campaign: classes, vulnerability by place and bit, and what protections would see and cost.

use std::collections::BTreeMap;

use emu::inject::{FaultKind, GoldenFrame, Protection, SeenFlip};
use schemars::JsonSchema;
use serde::Serialize;

use super::cost::ProtectionCost;
use super::row::{InjectionClass, InjectionRow};
use super::statistics::{GroupCount, ShareInterval};
use super::unprotected::{UnprotectedBits, unprotected};
use super::{FaultCampaign, SCHEMA};
use crate::job::{Job, result_name};

/// Structures that a result names as the most vulnerable ones.
const MOST_NAMED: usize = 3;

/// A campaign on one picture.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct InjectResult {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// Name of the scene.
    pub scene: String,
    /// Name of the kernels' profile.
    pub profile: &'static str,
    /// Name of the layout.
    pub layout: &'static str,
    /// Width of the drawn part in pixels.
    pub width: u32,
    /// Height of the drawn part in pixels.
    pub height: u32,
    /// Beginning of the series of random numbers.
    pub seed: u64,
    /// Bits that flip together.
    pub bits: u32,
    /// Places of several bits: adjacent or scattered.
    pub pattern: &'static str,
    /// Sums of the frame without a fault.
    pub golden: GoldenSums,
    /// Limits at which a program counts as hanging.
    pub limits: HangLimits,
    /// A result for each structure.
    pub kinds: Vec<KindVulnerability>,
    /// The most vulnerable structures, at most three, the worst first; those of equal shares in the order of the kinds.
    pub most_vulnerable: Vec<String>,
    /// Bits that may be left unprotected for a picture within 1/255.
    pub unprotected: Vec<UnprotectedBits>,
}

/// Sums of the frame without a fault.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct GoldenSums {
    /// Work items.
    pub items: u64,
    /// Instructions of the cores.
    pub steps: u64,
    /// Elementary operations of the cores.
    pub elementary: u64,
    /// Octets that the cores moved, messages among them.
    pub octets: u64,
}

/// Limits at which a program counts as hanging.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct HangLimits {
    /// Steps of a work item.
    pub item_steps: u64,
    /// Steps of the main processor.
    pub main_steps: u64,
    /// Work items that the main processor may hand out.
    pub items: u64,
}

/// Injections into one structure.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct KindVulnerability {
    /// Name of the structure, or of what goes wrong.
    pub kind: String,
    /// Protection of it: none, parity, ecc, duplicated, residue, retry or watchdog.
    pub protection: &'static str,
    /// Injections, the sum of the classes.
    pub injections: u64,
    /// The classes in their order.
    pub classes: Vec<ClassShare>,
    /// Share of injections after which there is no right picture, and nobody knows: wrong_pixel, trap and hang.
    pub vulnerability: ShareInterval,
    /// Wrong pixels in figures.
    pub pixels: PixelHarm,
    /// Traps by their faults.
    pub traps: Vec<FaultCount>,
    /// Hangs by the limits that found them.
    pub hangs: Vec<HangCount>,
    /// By part of the structure.
    pub by_structure: Vec<GroupShare>,
    /// By function.
    pub by_function: Vec<GroupShare>,
    /// By format of a number or field of memory.
    pub by_format: Vec<GroupShare>,
    /// By the lowest bit of the word that flips.
    pub by_bit: Vec<GroupShare>,
    /// Protections that the structure could have, what they would see of the harmful injections, and what they cost.
    pub protections: Vec<ProtectionEffect>,
}

/// Share of a class.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ClassShare {
    /// The class.
    pub class: InjectionClass,
    /// Injections of it.
    pub count: u64,
    /// Share of all.
    #[serde(flatten)]
    pub share: ShareInterval,
}

/// Wrong pixels of the injections of the class `wrong_pixel`.
#[derive(Clone, Debug, Default, Serialize, JsonSchema)]
pub struct PixelHarm {
    /// Injections whose pixels all differ by less than 1/255.
    pub within_step: u64,
    /// The others.
    pub beyond_step: u64,
    /// Largest difference of a component, in [0, 1].
    pub largest_difference: f64,
    /// Half of the injections have a largest difference of at most this.
    pub median_difference: f64,
    /// Most wrong pixels of an injection.
    pub most_pixels: u64,
}

/// Traps of one fault.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct FaultCount {
    /// Name of the fault.
    pub fault: String,
    /// Injections.
    pub count: u64,
}

/// Hangs that one limit found.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct HangCount {
    /// Name of the limit.
    pub limit: String,
    /// Injections.
    pub count: u64,
    /// Most steps of the guest up to it.
    pub most_steps: u64,
}

/// Injections that have something in common.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct GroupShare {
    /// Name of what they have in common.
    pub name: String,
    /// Injections.
    pub injections: u64,
    /// Harmful ones: wrong_pixel, trap and hang.
    pub harmful: u64,
    /// Harmful ones that leave no picture within 1/255.
    pub beyond_step: u64,
    /// Share of the harmful ones.
    #[serde(flatten)]
    pub share: ShareInterval,
}

/// Effect of a protection on the harmful injections.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ProtectionEffect {
    /// Name of the protection.
    pub protection: &'static str,
    /// Harmful injections that it puts right.
    pub corrected: u64,
    /// Harmful injections that it finds.
    pub detected: u64,
    /// Harmful injections that it does not see, or makes worse.
    pub passed: u64,
    /// Injections, harmful or not, of which it leaves other bits wrong than flipped: what comes of those only a run with it tells.
    pub unknown: u64,
    /// Vulnerability that is left, where it sees a flip as soon as that happens; its interval goes from no harm of the unknown ones to harm of all.
    pub left: ShareInterval,
    /// Cost of it.
    pub cost: ProtectionCost,
}

/// Shares of groups, in the order of their keys.
fn grouped<K: Ord + ToString>(rows: &[&InjectionRow], key: impl Fn(&InjectionRow) -> Option<K>) -> Vec<GroupShare> {
    let mut groups: BTreeMap<K, GroupCount> = BTreeMap::new();
    for row in rows {
        let Some(key) = key(row) else { continue };
        let group = groups.entry(key).or_default();
        group.injections += 1;
        group.harmful += u64::from(row.class.is_harmful());
        group.beyond += u64::from(!row.is_within_step());
    }
    let share = |(key, group): (K, GroupCount)| GroupShare {
        name: key.to_string(),
        injections: group.injections,
        harmful: group.harmful,
        beyond_step: group.beyond,
        share: ShareInterval::of(group.harmful, group.injections),
    };
    groups.into_iter().map(share).collect()
}

impl InjectResult {
    /// The result of rows, of each kind in the order of their numbers, with the costs of protections that [`super::protection_costs`] has.
    pub fn new(
        job: &Job,
        golden: &GoldenFrame,
        campaign: &FaultCampaign,
        costs: &BTreeMap<(FaultKind, Protection), ProtectionCost>,
        rows: &[InjectionRow],
    ) -> InjectResult {
        let (totals, limits, crop) = (golden.totals(), golden.limits(), job.crop());
        let mut kinds = Vec::new();
        // Judge each structure by its own injections
        for &kind in &campaign.kinds {
            let rows: Vec<&InjectionRow> = rows.iter().filter(|row| row.kind == kind.name()).collect();
            kinds.push(KindVulnerability::new(kind, campaign.protection(kind), &rows, costs));
        }
        // Rank those that were hit; the sort is stable, so equal shares stay in the order of the kinds
        let mut worst: Vec<&KindVulnerability> = kinds.iter().filter(|kind| kind.injections != 0).collect();
        worst.sort_by(|a, b| b.vulnerability.share.total_cmp(&a.vulnerability.share));
        let most_vulnerable = worst.iter().take(MOST_NAMED).map(|kind| kind.kind.clone()).collect();
        InjectResult {
            schema: SCHEMA,
            scene: result_name(&job.scene),
            profile: job.kernels.profile.name(),
            layout: job.layout().name(),
            width: crop.width,
            height: crop.height,
            seed: campaign.seed,
            bits: campaign.shape.bits,
            pattern: campaign.shape.pattern.name(),
            golden: GoldenSums {
                items: totals.items,
                steps: totals.steps,
                elementary: totals.elementary,
                octets: totals.octets,
            },
            limits: HangLimits { item_steps: limits.item, main_steps: limits.main, items: limits.items as u64 },
            most_vulnerable,
            unprotected: unprotected(&campaign.kinds, campaign.shape.bits, rows),
            kinds,
        }
    }
}

impl KindVulnerability {
    fn new(
        kind: FaultKind,
        protection: Protection,
        rows: &[&InjectionRow],
        costs: &BTreeMap<(FaultKind, Protection), ProtectionCost>,
    ) -> KindVulnerability {
        let injections = rows.len() as u64;
        let count = |class: InjectionClass| rows.iter().filter(|row| row.class == class).count() as u64;
        let classes = InjectionClass::ALL.map(|class| {
            let count = count(class);
            ClassShare { class, count, share: ShareInterval::of(count, injections) }
        });
        let harmful: Vec<&InjectionRow> = rows.iter().copied().filter(|row| row.class.is_harmful()).collect();
        let mut traps: BTreeMap<&str, u64> = BTreeMap::new();
        let mut hangs: BTreeMap<&str, (u64, u64)> = BTreeMap::new();
        for row in &harmful {
            if let Some(fault) = &row.trap {
                *traps.entry(fault).or_default() += 1;
            }
            if let Some(limit) = &row.limit {
                let (count, most) = hangs.entry(limit).or_default();
                *count += 1;
                *most = (*most).max(row.steps.unwrap_or(0));
            }
        }
        let effects = costs.iter().filter(|((other, _), _)| *other == kind).map(|(&(_, protection), cost)| {
            let (mut corrected, mut detected, mut passed, mut unknown, mut unknown_passed) = (0, 0, 0, 0, 0);
            for row in rows {
                let is_harmful = row.class.is_harmful();
                let seen = match protection {
                    // Where nothing happens any more a watchdog sees it, and a request that is made again is granted.
                    Protection::Watchdog if row.class == InjectionClass::Hang => SeenFlip::Detected,
                    Protection::Retry if row.class == InjectionClass::Hang => SeenFlip::Corrected,
                    protection => protection.sees(row.mask(), row.change),
                };
                let is_other = matches!(seen, SeenFlip::Passed(mask) if mask != row.mask());
                unknown += u64::from(is_other);
                match seen {
                    _ if !is_harmful => {}
                    SeenFlip::Corrected => corrected += 1,
                    SeenFlip::Detected => detected += 1,
                    SeenFlip::Passed(_) => {
                        passed += 1;
                        unknown_passed += u64::from(is_other);
                    }
                }
            }
            let sure = passed - unknown_passed;
            let left = ShareInterval::between(sure, passed, sure + unknown, injections);
            let (protection, cost) = (protection.name(), cost.clone());
            ProtectionEffect { protection, corrected, detected, passed, unknown, left, cost }
        });
        let counted = |(fault, count): (&str, u64)| FaultCount { fault: fault.to_owned(), count };
        KindVulnerability {
            kind: kind.name().to_owned(),
            protection: protection.name(),
            injections,
            classes: classes.to_vec(),
            vulnerability: ShareInterval::of(harmful.len() as u64, injections),
            pixels: PixelHarm::new(rows),
            traps: traps.into_iter().map(counted).collect(),
            hangs: hangs
                .into_iter()
                .map(|(limit, (count, most_steps))| HangCount { limit: limit.to_owned(), count, most_steps })
                .collect(),
            by_structure: grouped(rows, |row| Some(row.structure.clone())),
            by_function: grouped(rows, |row| row.function.clone()),
            by_format: grouped(rows, |row| row.format.clone()),
            by_bit: grouped(rows, |row| row.bits.first().copied()),
            // What is protected already has shown what it sees.
            protections: if protection == Protection::Unprotected { effects.collect() } else { Vec::new() },
        }
    }
}

impl PixelHarm {
    fn new(rows: &[&InjectionRow]) -> PixelHarm {
        let wrong: Vec<&&InjectionRow> = rows.iter().filter(|row| row.class == InjectionClass::WrongPixel).collect();
        let mut differences: Vec<f64> = wrong.iter().map(|row| row.largest_difference).collect();
        differences.sort_by(f64::total_cmp);
        let within_step = wrong.iter().filter(|row| row.is_within_step()).count() as u64;
        PixelHarm {
            within_step,
            beyond_step: wrong.len() as u64 - within_step,
            largest_difference: differences.last().copied().unwrap_or(0.0),
            median_difference: differences.get(differences.len().saturating_sub(1) / 2).copied().unwrap_or(0.0),
            most_pixels: wrong.iter().map(|row| row.wrong_pixels).max().unwrap_or(0),
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub fn row(number: u64, class: InjectionClass, bit: u32, difference: f64) -> InjectionRow {
        InjectionRow {
            kind: "registers".to_owned(),
            number,
            class,
            item: 0,
            pixel: Some(0),
            moment: 0,
            structure: "scalars".to_owned(),
            place: "s1".to_owned(),
            function: Some("sqrt".to_owned()),
            format: Some("pos".to_owned()),
            format_bits: vec![bit],
            bits: vec![bit],
            change: 0,
            wrong_pixels: u64::from(class == InjectionClass::WrongPixel),
            largest_difference: difference,
            trap: (class == InjectionClass::Trap).then(|| "memory".to_owned()),
            trap_at: None,
            limit: None,
            steps: None,
            items: 1,
        }
    }

    #[test]
    fn classes_and_groups_add_up() {
        use InjectionClass::{Masked, Trap, WrongPixel};
        let rows =
            [row(0, Masked, 0, 0.0), row(1, WrongPixel, 0, 0.5), row(2, WrongPixel, 4, 0.001), row(3, Trap, 31, 0.0)];
        let kind = KindVulnerability::new(
            FaultKind::Registers,
            Protection::Unprotected,
            &rows.iter().collect::<Vec<_>>(),
            &BTreeMap::from([((FaultKind::Registers, Protection::Parity), ProtectionCost::default())]),
        );
        assert_eq!(kind.classes.iter().map(|class| class.count).sum::<u64>(), 4);
        assert_eq!(kind.vulnerability.share, 0.75);
        assert_eq!((kind.pixels.within_step, kind.pixels.beyond_step, kind.pixels.largest_difference), (1, 1, 0.5));
        assert_eq!((kind.traps.len(), kind.by_bit.len(), kind.by_function[0].harmful), (1, 3, 3));
        assert_eq!((kind.protections[0].detected, kind.protections[0].passed), (3, 0));
    }

    #[test]
    fn a_code_that_leaves_other_bits_wrong_says_what_it_does_not_know() {
        use InjectionClass::{Masked, WrongPixel};
        let with_bits =
            |number, class, bits: &[u32]| InjectionRow { bits: bits.to_vec(), ..row(number, class, 0, 0.5) };
        // Two bits are always found; of three some look like a fourth.
        let unseen = |bits: &&[u32; 3]| {
            let mask = bits.iter().map(|bit| 1u32 << bit).sum();
            matches!(Protection::Secded.sees(mask, 0), SeenFlip::Passed(other) if other != mask)
        };
        let threes: Vec<[u32; 3]> = (2..32).map(|bit| [0, 1, bit]).collect();
        let three = threes.iter().find(unseen).expect("the code has seven bits");
        let rows = [
            with_bits(0, WrongPixel, &[0, 1]),
            with_bits(1, WrongPixel, three),
            with_bits(2, Masked, three),
            with_bits(3, Masked, &[3]),
        ];
        let kind = KindVulnerability::new(
            FaultKind::Registers,
            Protection::Unprotected,
            &rows.iter().collect::<Vec<_>>(),
            &BTreeMap::from([((FaultKind::Registers, Protection::Secded), ProtectionCost::default())]),
        );
        let effect = &kind.protections[0];
        assert_eq!((effect.corrected, effect.detected, effect.passed, effect.unknown), (0, 1, 1, 2));
        let (none, both) = (ShareInterval::of(0, 4), ShareInterval::of(2, 4));
        assert_eq!(effect.left, ShareInterval { share: 0.25, low: none.low, high: both.high });
    }
}
