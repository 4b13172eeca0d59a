//! Recordings as octets, for other processes to replay. All numbers are little-endian and stand one behind the other; a transfer takes 7 octets,
//! because transfers that differ in nothing but their address share one entry of a table. Who keeps them, and how long, is not said here.

use std::collections::HashMap;
use std::sync::Arc;

use isa::number::Vector;

use super::crew::AT_ONCE;
use super::feed::Batch;
use super::prerun::ItemTotals;
use super::record::Prefix;
use super::recorded::Recorded;
use super::recording::{Portion, Reason, Recording, Segment, Stretch, reads};
use crate::code::Code;
use crate::code::quantity::Octets;
use crate::code::tally::Tally;
use crate::engine::Pause;
use crate::machine::kinds::Kinds;
use crate::machine::{Setup, check};
use crate::semantics::Message;

/// Version of the octets: whatever changes the meaning of one of them changes it.
pub const RECORDING_FORMAT: u32 = 1;

/// Octets of a segment: three of the number of its shape, four of its address.
const SEGMENT: usize = 7;

/// Shapes that three octets can tell apart.
const MOST_SHAPES: usize = 1 << 24;

/// Octets of a shape.
const SHAPE: usize = 12;

/// Octets of an item whose message has one vector, without segments and without messages that it sends.
const LEAST_ITEM: usize = 1 + 12 + 8 + 8 + 8 + 4 + 4 + 4;

/// Passes, units and clocks that a count may come to: far more than a frame takes.
const MOST_COUNT: u64 = 1 << 48;

/// Sum of all counts of a recording, so that whatever is added up of them fits.
const MOST_SUM: u64 = 1 << 60;

const CUT_SHORT: Reason = "it is cut short";
const FOREIGN: Reason = "it is of another program";
const IMPOSSIBLE: Reason = "it holds what no work item does";

impl Recorded {
    /// The recording as octets. `None` for one that would not serve every machine that computes alike, or not with every result: where an
    /// item depends on the number of cores or ends in a fault, where the main processor does not come to its end, and where clocks of
    /// functions were measured.
    ///
    /// The first octets of a recording for 2 cores whose prefix takes 300 clocks up to the receive at word 7, and of a program with 5 outcomes:
    ///
    /// | octets | meaning |
    /// | --- | --- |
    /// | `02 00 00 00` | number of cores |
    /// | `07 00 00 00` | word of the receive |
    /// | `2c 01 00 00 00 00 00 00` | clocks of the prefix: 300 = 0x12c |
    /// | `05 00 00 00` | number of counts, then three numbers for each |
    ///
    /// Losses, octets by kind, the table of shapes and the items come next, each with a number of its own in front.
    pub fn encode(&self) -> Option<Vec<u8>> {
        // Refuse what other machines could not use
        let is_kept = |item: &Recording| item.end == Pause::Halt && !item.depends_on_cores && item.clocks.is_none();
        let batches: Vec<&Vec<Arc<Portion>>> =
            self.batches.iter().map(|batch| batch.as_ref().as_ref().ok()).collect::<Option<_>>()?;
        let is_plain = self.totals.profile.is_none() && self.totals.keys.is_empty();
        if !self.is_whole
            || !is_plain
            || !batches.iter().copied().flatten().flat_map(|portion| &portion.items).all(is_kept)
        {
            return None;
        }
        // Items first, since the table of shapes is known when the last of them is written
        let mut shapes = ShapeTable::default();
        let mut items = Vec::with_capacity(SEGMENT * self.segments());
        put_length(&mut items, batches.len())?;
        for batch in batches {
            put_length(&mut items, batch.iter().map(|portion| portion.items.len()).sum())?;
            for portion in batch {
                for item in &portion.items {
                    put_item(&mut items, portion, item, &mut shapes)?;
                }
            }
        }
        // Head and totals, then the table and the items
        let Recorded { prefix, cores, totals, .. } = self;
        let mut octets = Vec::with_capacity(items.len() + SHAPE * shapes.shapes.len() + (1 << 16));
        put_words(&mut octets, [*cores, prefix.pc]);
        put_numbers(&mut octets, [prefix.clocks]);
        put_length(&mut octets, totals.tally.all().len())?;
        for passes in totals.tally.all() {
            put_numbers(&mut octets, [passes.count, passes.units, passes.unit_clocks]);
        }
        put_length(&mut octets, totals.tally.slot_losses().len())?;
        for losses in totals.tally.slot_losses() {
            put_numbers(&mut octets, [losses.quantized, losses.overflowed]);
        }
        put_length(&mut octets, totals.kinds.totals().len())?;
        put_numbers(&mut octets, totals.kinds.totals().iter().map(|kind| kind.octets.0));
        put_length(&mut octets, shapes.shapes.len())?;
        put_words(&mut octets, shapes.shapes.into_iter().flatten());
        octets.append(&mut items);
        Some(octets)
    }

    /// The recording that octets hold, for a machine that computes as the one that it was made for. Takes no more memory than five times
    /// the octets, whatever they are.
    ///
    /// A number of things is believed only where the rest has room for them at their least: 1,000 batches in the last 5,000 octets are refused before
    /// there is a place for any, since each takes at least its number of items, 4 octets, and one item, 49: together 53,000.
    ///
    /// # Errors
    /// Octets that hold no recording of this program, with the reason.
    pub fn decode(setup: &Setup, octets: &[u8]) -> Result<Recorded, Reason> {
        check(setup).map_err(|_| "the machine cannot be used")?;
        let code = Code::new(setup.core, setup.isa, setup.config.timing());
        // Read head and totals, which have to fit the program
        let mut reader = OctetReader { rest: octets, sum: 0 };
        let [cores, pc] = reader.words()?;
        let [clocks] = reader.numbers()?;
        let prefix = Prefix { clocks, pc };
        let totals = totals(&mut reader, &code, setup)?;
        let slots = code.slots().len() as u32;
        if pc >= slots {
            return Err(FOREIGN);
        }
        // Read the table of shapes, which items name by number
        let count = reader.length(SHAPE)?;
        let shapes = (0..count).map(|_| reader.words()).collect::<Result<Vec<[u32; 3]>, Reason>>()?;
        if shapes.iter().any(|&[_, pc, _]| pc >= slots) {
            return Err(FOREIGN);
        }
        // Read the batches, in the portions in which a prerun would have recorded them
        let count = reader.length(4 + LEAST_ITEM)?;
        let mut batches = Vec::with_capacity(count);
        for _ in 0..count {
            let count = reader.length(LEAST_ITEM)?;
            if count == 0 {
                return Err(IMPOSSIBLE);
            }
            let mut portions = Vec::new();
            for at in (0..count).step_by(AT_ONCE) {
                let mut portion = Portion::default();
                for _ in at..count.min(at + AT_ONCE) {
                    read_item(&mut reader, &shapes, slots, &mut portion)?;
                }
                portions.push(portion.closed());
            }
            batches.push(Arc::new(Batch::Ok(portions)));
        }
        if !reader.rest.is_empty() {
            return Err("it is longer than it says");
        }
        Ok(Recorded { prefix, cores, batches, totals, is_whole: true })
    }
}

/// Numbers of shapes in the order in which they are met.
struct ShapeTable {
    shapes: Vec<[u32; 3]>,
    numbers: HashMap<[u32; 3], u32>,
    /// The shapes that were met last, by a few of their bits: mostly the same ones come again.
    recent: Vec<([u32; 3], u32)>,
}

impl Default for ShapeTable {
    fn default() -> ShapeTable {
        // No segment has this shape: its access would be a write.
        ShapeTable { shapes: Vec::new(), numbers: HashMap::new(), recent: vec![([u32::MAX; 3], 0); Self::RECENT] }
    }
}

impl ShapeTable {
    const RECENT: usize = 1 << 12;

    fn number(&mut self, shape: [u32; 3]) -> Option<u32> {
        let place = (shape[0].wrapping_mul(31) ^ shape[1].wrapping_mul(9) ^ shape[2]) as usize % Self::RECENT;
        let (known, number) = self.recent[place];
        if known == shape {
            return Some(number);
        }
        let new = self.shapes.len();
        let number = *self.numbers.entry(shape).or_insert(new as u32);
        if number as usize == new {
            self.shapes.push(shape);
        }
        self.recent[place] = (shape, number);
        (self.shapes.len() <= MOST_SHAPES).then_some(number)
    }
}

fn put_words(out: &mut Vec<u8>, words: impl IntoIterator<Item = u32>) {
    out.extend(words.into_iter().flat_map(u32::to_le_bytes));
}

fn put_numbers(out: &mut Vec<u8>, numbers: impl IntoIterator<Item = u64>) {
    out.extend(numbers.into_iter().flat_map(u64::to_le_bytes));
}

/// Writes how many there are of something; `None` where that does not fit.
fn put_length(out: &mut Vec<u8>, length: usize) -> Option<()> {
    put_words(out, [u32::try_from(length).ok()?]);
    Some(())
}

fn put_message(out: &mut Vec<u8>, message: &Message) {
    out.push(message.vectors().len() as u8);
    put_words(out, message.vectors().iter().flatten().map(|&component| component as u32));
}

/// Writes an item. A segment `(7 clocks, word 5, read of 4 octets)` at address 400 whose shape has number 2 is `02 00 00 90 01 00 00`.
fn put_item(out: &mut Vec<u8>, portion: &Portion, item: &Recording, shapes: &mut ShapeTable) -> Option<()> {
    let (sent, segments) = (portion.sent(item), portion.segments(item));
    put_message(out, &item.message);
    put_numbers(out, [item.steps, item.elementary, item.last_clocks]);
    put_words(out, [item.last_pc]);
    put_length(out, sent.len())?;
    sent.iter().for_each(|message| put_message(out, message));
    put_length(out, segments.len())?;
    for segment in segments {
        let shape = shapes.number(segment.shape())?.to_le_bytes();
        let address = segment.address.to_le_bytes();
        out.extend_from_slice(&[shape[0], shape[1], shape[2], address[0], address[1], address[2], address[3]]);
    }
    Some(())
}

/// Octets that have not been read.
struct OctetReader<'a> {
    rest: &'a [u8],
    /// Sum of the numbers up to here.
    sum: u64,
}

impl<'a> OctetReader<'a> {
    fn take(&mut self, octets: usize) -> Result<&'a [u8], Reason> {
        let (taken, rest) = self.rest.split_at_checked(octets).ok_or(CUT_SHORT)?;
        self.rest = rest;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], Reason> {
        let (taken, rest) = self.rest.split_first_chunk().ok_or(CUT_SHORT)?;
        self.rest = rest;
        Ok(*taken)
    }

    fn words<const N: usize>(&mut self) -> Result<[u32; N], Reason> {
        let mut words = [0; N];
        for word in &mut words {
            *word = u32::from_le_bytes(self.array()?);
        }
        Ok(words)
    }

    fn numbers<const N: usize>(&mut self) -> Result<[u64; N], Reason> {
        let mut numbers = [0; N];
        for number in &mut numbers {
            *number = u64::from_le_bytes(self.array()?);
            // Each is checked by itself first, so that the sum cannot wrap.
            if *number > MOST_COUNT || self.sum + *number > MOST_SUM {
                return Err(IMPOSSIBLE);
            }
            self.sum += *number;
        }
        Ok(numbers)
    }

    /// Number of things, each of which takes at least so many octets; no more than the rest has room for.
    fn length(&mut self, each: usize) -> Result<usize, Reason> {
        let [length] = self.words()?;
        let length = length as usize;
        if length.checked_mul(each).is_none_or(|octets| octets > self.rest.len()) { Err(CUT_SHORT) } else { Ok(length) }
    }

    fn message(&mut self) -> Result<Message, Reason> {
        let [length] = self.array()?;
        let mut vectors = [[0; 3]; 5];
        let vectors: &mut [Vector] = vectors.get_mut(..length.into()).ok_or(IMPOSSIBLE)?;
        for vector in &mut *vectors {
            *vector = self.words()?.map(|word| word as i32);
        }
        Message::of_vectors(vectors).ok_or(IMPOSSIBLE)
    }
}

/// Totals with as many counts as the program has words and outcomes.
fn totals(reader: &mut OctetReader, code: &Code, setup: &Setup) -> Result<ItemTotals, Reason> {
    let (mut tally, mut kinds) = (Tally::new(code), Kinds::new(&setup.kinds));
    let (all, losses) = tally.parts_mut();
    if reader.length(24)? != all.len() {
        return Err(FOREIGN);
    }
    for passes in all {
        [passes.count, passes.units, passes.unit_clocks] = reader.numbers()?;
    }
    if reader.length(16)? != losses.len() {
        return Err(FOREIGN);
    }
    for losses in losses {
        [losses.quantized, losses.overflowed] = reader.numbers()?;
    }
    let count = reader.length(8)?;
    if count != kinds.totals().len() {
        return Err(FOREIGN);
    }
    for kind in 0..count {
        let [octets] = reader.numbers()?;
        kinds.add_octets(kind, Octets(octets));
    }
    Ok(ItemTotals { tally, kinds, profile: None, keys: Vec::new() })
}

/// Reads an item into a portion; its octets and the range that it reads follow from its segments.
fn read_item(reader: &mut OctetReader, shapes: &[[u32; 3]], slots: u32, portion: &mut Portion) -> Result<(), Reason> {
    let track = Arc::get_mut(&mut portion.track).expect("nobody else has it");
    let (first_segment, first_message) = (track.segments.len(), portion.sent.len());
    let message = reader.message()?;
    let [steps, elementary, last_clocks] = reader.numbers()?;
    let [last_pc] = reader.words()?;
    let count = reader.length(13)?;
    for _ in 0..count {
        portion.sent.push(reader.message()?);
    }
    let sent = count;
    let count = reader.length(SEGMENT)?;
    track.segments.reserve(count);
    for octets in reader.take(count * SEGMENT)?.chunks_exact(SEGMENT) {
        let &[s0, s1, s2, a0, a1, a2, a3] = octets else { return Err(IMPOSSIBLE) };
        let shape = shapes.get(u32::from_le_bytes([s0, s1, s2, 0]) as usize).ok_or(IMPOSSIBLE)?;
        let segment = Segment::of_shape(*shape, u32::from_le_bytes([a0, a1, a2, a3]));
        track.segments.push(segment.ok_or(IMPOSSIBLE)?);
    }
    let segments = &track.segments[first_segment..];
    // The address of a message is its number.
    let is_sent = |segment: &Segment| segment.is_read() || (segment.address as usize) < sent;
    if last_pc >= slots || !segments.iter().all(is_sent) {
        return Err(IMPOSSIBLE);
    }
    let octets = segments.iter().fold(Octets(0), |sum, segment| sum + segment.octets());
    portion.items.push(Recording {
        message,
        octets,
        stretch: Stretch { segments: first_segment..track.segments.len(), reads: reads(segments) },
        sent: first_message..portion.sent.len(),
        clocks: None,
        last_clocks,
        last_pc,
        end: Pause::Halt,
        steps,
        elementary,
        depends_on_cores: false,
    });
    Ok(())
}
