//! The search for the fewest bits: of a word in which scenes choose their formats, then of each quantity in turn, in the order of what a bit costs.

use scenes::kdtree::BuildMethod;

use super::ChoiceFigures;
use super::choice::{DemandedError, FormatChoice, integer_bits};
use super::trial::FormatTrials;
use crate::failure::Failure;

/// Least and most bits of a word.
pub const WORDS: (u32, u32) = (8, 32);

/// Longest word in which positions that are given have steps that fit the scene, as those have that a scene chooses in words below 32 bits.
const LONGEST_FITTED: u32 = 31;

/// Number of positions in [`FormatChoice::bits`].
const POSITION: usize = 0;

/// Numbers of the quantities in the order of what their bits cost, as [`FormatChoice::bits`] has them: positions fill memory and so the bus;
/// distances follow them; the others cost bits of registers.
pub const ORDER: [usize; 6] = [POSITION, 3, 1, 4, 5, 2];

/// Numbers of weights and colours. Their rounding makes each pixel a little different and none another one, so that what was not seen differs little
/// from what was; half the guard is enough, which is 6 dB for the usual 2 bits.
const SMOOTH: [usize; 2] = [4, 5];

/// Costs of visiting a node in percent of testing a triangle that are tried, the dearest first. A node of the layout `packed` takes about a fifth of the
/// octets of a triangle.
const VISITS: [u32; 4] = [50, 25, 12, 6];

/// Longer formats that have to keep the demand beside one that does. A picture may be lucky: rays pass edges by less than the format tells apart, and
/// with one bit more a pixel flips.
const RUN: i32 = 3;

/// Bits of a quantity on the way to its fewest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct QuantitySearch {
    /// Bits before the point and the sign, of the scene that needs most.
    pub integer: i32,
    /// Fraction bits of the word that the search starts from.
    pub start: i32,
    /// First estimate of the fraction bits, from the demand alone.
    pub estimate: i32,
    /// Fewest fraction bits that keep the demand, and the guard, beside the quantities before it and the others at their start; the start where the
    /// choice leaves the quantity to the scenes.
    pub fewest: i32,
}

/// Outcome of a search.
#[derive(Clone, Debug)]
pub struct FormatSearch {
    /// Quantities, in the order of [`FormatChoice::bits`].
    pub quantities: [QuantitySearch; 6],
    /// The choice that moves the fewest octets, with the tree in which it does.
    pub found: FormatChoice,
    /// The shortest word in which the scenes choose their formats and keep the demand, and the guard.
    pub uniform: u32,
}

/// The fewest bits of everything; `None` where the longest word does not keep the demand. `guard` bits are added to what keeps it,
/// half as many to [`SMOOTH`] quantities.
///
/// Two choices are made, and the one that moves fewer octets is the answer, the second where they move as much. In the first all quantities are given, each as short as it may be and one for
/// all scenes: scenes with small boxes then have narrow positions. In the second each scene has the positions that the shortest uniform word gives it,
/// and the other quantities are given. So the answer moves no more than that word, unless each is refused; then the word itself is the answer.
/// Last, a tree is chosen for the answer.
///
/// # Errors
/// See [`FormatTrials::keeps`].
pub fn search(trials: &mut FormatTrials, demand: DemandedError, guard: i32) -> Result<Option<FormatSearch>, Failure> {
    let (least, most) = WORDS;
    let guess = first_word(demand);
    let mut keeps = |word: i32| trials.keeps(FormatChoice::uniform(word as u32));
    let Some(kept) = safest(least as i32, most as i32, guess, &mut keeps)? else { return Ok(None) };
    // A longer word than the one that keeps the demand by three others may still be an unlucky one.
    let mut uniform = (kept + guard).min(most as i32);
    while uniform < most as i32 && !keeps(uniform)? {
        uniform += 1;
    }
    let uniform = if keeps(uniform)? { uniform as u32 } else { kept as u32 };
    let is_fitted = kept < most as i32 && trials.keeps(FormatChoice::uniform(LONGEST_FITTED))?;
    let long = FormatChoice::uniform(if is_fitted { LONGEST_FITTED } else { most });
    let mut given = Shortening::new(trials, demand, long);
    let position = trials.formats(&FormatChoice::uniform(kept as u32)).iter().map(|formats| formats.position).min();
    let mut guesses = given.quantities.map(|quantity| Some(quantity.estimate));
    guesses[POSITION] = position.or(guesses[POSITION]);
    given.shorten(trials, guard, guesses)?;
    given.word(trials)?;
    let plain = Shortening::new(trials, demand, FormatChoice::uniform(uniform));
    let mut chosen = plain.clone();
    let mut guesses = std::array::from_fn(|at| Some(given.quantities[at].fewest - guard_of(at, guard)));
    guesses[POSITION] = None;
    chosen.shorten(trials, guard, guesses)?;
    // With a large guard none may keep the demand, which figures then say. Of choices that move as much, one with shorter quantities.
    let mut ranked = Vec::new();
    for one in [chosen, given, plain] {
        let figures = ChoiceFigures::of(trials.measure(one.choice)?);
        ranked.push((!figures.is_kept, figures.octets, one));
    }
    let best = ranked.into_iter().min_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let Some((_, octets, Shortening { quantities, choice })) = best else { return Ok(None) };
    let found = with_tree(trials, choice, octets)?;
    Ok(Some(FormatSearch { quantities, found, uniform }))
}

/// The choice with the tree in which it moves the fewest octets, if it moves `octets` a pixel in the job's.
///
/// A tree for visits that cost less has more nodes and smaller leaves. It changes no picture, so only octets are compared: they fall until nodes cost more
/// than the tests that they save.
fn with_tree(trials: &mut FormatTrials, choice: FormatChoice, octets: f64) -> Result<FormatChoice, Failure> {
    let (mut found, mut least) = (choice, octets);
    if trials.job.kd_method() != BuildMethod::Binned {
        return Ok(found);
    }
    for visit in VISITS {
        let choice = FormatChoice { visit: Some(visit), ..choice };
        let figures = ChoiceFigures::of(trials.measure(choice)?);
        if figures.octets >= least {
            break;
        }
        (found, least) = (choice, figures.octets);
    }
    Ok(found)
}

/// A choice whose quantities become shorter one after the other.
#[derive(Clone, Debug)]
struct Shortening {
    quantities: [QuantitySearch; 6],
    choice: FormatChoice,
}

impl Shortening {
    /// The choice to start from, in which scenes choose their formats.
    fn new(trials: &FormatTrials, demand: DemandedError, choice: FormatChoice) -> Shortening {
        let formats = trials.formats(&choice);
        // Ranges: what stands before the point, of the scene that needs most; a format is one for all scenes, so it has the fraction bits of the
        // scene that has fewest.
        let quantity = |at: usize| {
            let integer = formats.iter().map(|one| integer_bits(one, at)).max().unwrap_or(2);
            let start = formats.iter().map(|one| one.entries()[at].1).min().unwrap_or(0);
            let estimate = estimate(at, (start, choice.word as i32), integer, demand);
            QuantitySearch { integer, start, estimate, fewest: start }
        };
        Shortening { quantities: std::array::from_fn(quantity), choice }
    }

    /// Gives each quantity its fewest bits, in their order, each from its guess on; one without a guess stays as the scenes choose it.
    fn shorten(&mut self, trials: &mut FormatTrials, guard: i32, guesses: [Option<i32>; 6]) -> Result<(), Failure> {
        for at in ORDER {
            let QuantitySearch { start, integer, .. } = self.quantities[at];
            let Some(guess) = guesses[at] else { continue };
            let is_place = at == POSITION || at == 3;
            let least = if is_place { start - self.choice.word as i32 + integer.max(2) } else { 0 };
            let choice = self.choice;
            let mut keeps = |bits: i32| trials.keeps(choice.with(at, bits));
            if let Some(found) = safest(least, start, guess, &mut keeps)? {
                // What no picture depends on needs no guard.
                let found = if found == least { found } else { (found + guard_of(at, guard)).min(start) };
                self.quantities[at].fewest = found;
                self.choice = choice.with(at, found);
            }
        }
        Ok(())
    }

    /// Makes the word as wide as the widest quantity, or wider where intermediates ask for it.
    fn word(&mut self, trials: &mut FormatTrials) -> Result<(), Failure> {
        let (least, most) = (WORDS.0 as i32, self.choice.word as i32);
        let widest = self.quantities.iter().map(|quantity| quantity.integer + quantity.fewest).max().unwrap_or(least);
        let choice = self.choice;
        let mut keeps = |word: i32| trials.keeps(FormatChoice { word: word as u32, ..choice });
        if let Some(word) = safest(least, most, widest, &mut keeps)? {
            self.choice.word = word as u32;
        }
        Ok(())
    }
}

/// Bits that are added to the fewest of a quantity.
fn guard_of(quantity: usize, guard: i32) -> i32 {
    if SMOOTH.contains(&quantity) { (guard + 1) / 2 } else { guard }
}

/// Word to begin with: half a step of a position flips pixels, so that twice the bits of the demanded error are asked for, a sign, and what
/// lies between a pixel and the box.
fn first_word(demand: DemandedError) -> i32 {
    (2.0 * -(demand.rmse() * 12f64.sqrt()).log2()) as i32 + 6
}

/// Fraction bits with which the rounding of one quantity alone comes to about the demanded error.
///
/// A unit in the last place of 2^-f, rounded to nearest, has a root mean square of 2^-f / sqrt 12. Colours and weights reach the picture
/// nearly as they are. Directions are multiplied by a few normals and ways; half a dozen roundings add two bits. Positions and distances move
/// what is seen: a step moves an edge by a share of a pixel, which flips pixels of that share of all edges, so that the square of the error, and
/// not the error, goes with the step.
fn estimate(quantity: usize, (start, word): (i32, i32), integer: i32, demand: DemandedError) -> i32 {
    let bits = -(demand.rmse() * 12f64.sqrt()).log2();
    let bits = match quantity {
        0 | 3 => {
            // Relative to the range that the quantity fills.
            let range = start + integer - word;
            return ((2.0 * bits) as i32 + range).clamp(start - word + 2, start);
        }
        1 => bits + 2.0,
        2 => 0.0,
        _ => bits,
    };
    (bits.ceil() as i32).clamp(0, start)
}

/// The least number from `least` to `most` that keeps something together with the [`RUN`] numbers above it; `None` where there is none.
///
/// Of numbers of which 11, 12 and 14 to 20 keep, but 13 does not, 11 is a lucky one, and 14 is the answer.
fn safest(
    mut least: i32,
    most: i32,
    mut guess: i32,
    keeps: &mut dyn FnMut(i32) -> Result<bool, Failure>,
) -> Result<Option<i32>, Failure> {
    loop {
        let Some(found) = fewest(least, most, guess, keeps)? else { return Ok(None) };
        let mut broken = None;
        for above in found + 1..=(found + RUN).min(most) {
            if !keeps(above)? {
                broken = Some(above);
                break;
            }
        }
        match broken {
            None => return Ok(Some(found)),
            Some(broken) if broken == most => return Ok(None),
            Some(broken) => (least, guess) = (broken + 1, broken + 1),
        }
    }
}

/// The least number from `least` to `most` that keeps something, if those above it do, too; `None` where `most` does not.
///
/// Steps away from the guess get longer until both sides are known: of a guess of 12 that keeps, 11, 9 and 5 are tried until one does not, then
/// the numbers between are halved.
fn fewest(
    least: i32,
    most: i32,
    guess: i32,
    keeps: &mut dyn FnMut(i32) -> Result<bool, Failure>,
) -> Result<Option<i32>, Failure> {
    // `bad` does not keep, `good` does.
    let (mut bad, mut good) = (least - 1, most + 1);
    let (mut at, mut step) = (guess.clamp(least, most), 1);
    loop {
        if keeps(at)? {
            good = at
        } else {
            bad = at
        }
        if good - bad <= 1 {
            return Ok((good <= most).then_some(good));
        }
        at = match (bad < least, good > most) {
            (true, _) => (at - step).max(least),
            (_, true) => (at + step).min(most),
            _ => bad + (good - bad) / 2,
        };
        step *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fewest_are_found_from_any_guess() {
        for answer in 3..=20 {
            for guess in -2..=25 {
                let mut tried = Vec::new();
                let mut keeps = |bits: i32| {
                    tried.push(bits);
                    Ok(bits >= answer)
                };
                let found = fewest(3, 20, guess, &mut keeps).unwrap();
                assert_eq!(found, Some(answer), "from {guess}: {tried:?}");
                assert!(tried.len() <= 10 && tried.iter().all(|bits| (3..=20).contains(bits)), "{guess}: {tried:?}");
            }
        }
        assert_eq!(fewest(3, 20, 9, &mut |_| Ok(false)).unwrap(), None);
    }

    #[test]
    fn a_lucky_number_is_none() {
        let mut keeps = |bits: i32| Ok(![13, 10].contains(&bits) && bits > 8);
        assert_eq!(safest(3, 20, 11, &mut keeps).unwrap(), Some(14));
        assert_eq!(safest(3, 20, 9, &mut keeps).unwrap(), Some(14));
        assert_eq!(safest(3, 20, 20, &mut |bits| Ok(bits != 20)).unwrap(), None);
        assert_eq!(safest(3, 20, 5, &mut |bits| Ok(bits >= 19)).unwrap(), Some(19));
    }

    #[test]
    fn a_tighter_demand_takes_more_bits() {
        for quantity in [0, 1, 3, 4, 5] {
            let bits = [40.0, 60.0, 80.0].map(|psnr| estimate(quantity, (27, 32), 5, DemandedError::Psnr(psnr)));
            assert!(bits.windows(2).all(|pair| pair[0] < pair[1]), "{quantity}: {bits:?}");
        }
        // 60 dB are 0.001: steps of 2^-8.2 have that error.
        assert_eq!(estimate(5, (29, 32), 3, DemandedError::Psnr(60.0)), 9);
    }
}
