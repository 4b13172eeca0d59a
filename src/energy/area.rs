//! Area of cores: units, registers, buffers and caches, by one published table.

use emu::inject::FaultKind;
use emu::machine::Config;
use schemars::JsonSchema;
use serde::Serialize;

use super::activity::Width;
use super::price::Pricing;
use crate::protection::core_words;

/// Scalar registers of a core, of 32 bits whatever the word; `s0` reads zero and has none.
const SCALARS: u64 = 31;

/// Vector registers, of three words.
const VECTORS: u64 = 32;

/// Accumulators, of two words.
const ACCUMULATORS: u64 = 8;

/// One line of a core's area.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct AreaLine {
    /// Name of the item, as a machine file has it.
    pub item: &'static str,
    /// Bits of the numbers of a unit; null where the item is a bit.
    pub bits: Option<u32>,
    /// Number of units or bits.
    pub count: u64,
    /// Square micrometres of one.
    pub each_um2: f64,
    /// Square micrometres of all.
    pub um2: f64,
    /// Formula and unit of the figure.
    pub formula: String,
    /// Source of the figure.
    pub source: String,
    /// True where no line was published, so that the figure is put together from others.
    pub is_derived: bool,
}

/// Area of a machine's cores by a published table; what the table lacks comes from another one, as the lines say. The main processor, the bus
/// and global memory are not in it.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct TableArea {
    /// Name of the table.
    pub table: &'static str,
    /// Process for which its figures are.
    pub technology: &'static str,
    /// Square micrometres of a core's units.
    pub units_um2: f64,
    /// Square micrometres of a core's registers.
    pub registers_um2: f64,
    /// Square micrometres of a core's buffer.
    pub buffer_um2: f64,
    /// Square micrometres of a core's cache.
    pub cache_um2: f64,
    /// Square micrometres of a core.
    pub core_um2: f64,
    /// Square micrometres of all cores.
    pub cores_um2: f64,
    /// Lines of a core.
    pub lines: Vec<AreaLine>,
    /// Items that a core has but nobody has a figure for.
    pub without_figure: Vec<&'static str>,
}

/// Square micrometres of square nanometres, the number that is nearest to the exact one.
fn micrometres(nanometres: u64) -> f64 {
    format!("{}.{:06}", nanometres / 1_000_000, nanometres % 1_000_000).parse().expect("it is a decimal number")
}

impl TableArea {
    /// Area of the cores of a machine.
    pub fn new(pricing: &Pricing, config: &Config) -> TableArea {
        let (word, units) = (config.arithmetic.word, config.timing().units);
        let unit = |item: &'static str| {
            (item, Some(word), units[isa::Class::from_name(item).expect("an item is named as its class")])
        };
        // Check bits stand beside each word of what is protected.
        let check = |kind| core_words(config, kind) * u64::from(config.protection.of(kind).check_bits());
        let bits = SCALARS * 32 + VECTORS * 3 * u64::from(word) + ACCUMULATORS * 2 * u64::from(word);
        let items = ["add", "sub", "mul", "div", "cmp"].map(unit).into_iter().chain([
            ("register", None, bits + check(FaultKind::Registers)),
            ("buffer", None, 8 * u64::from(config.buffer_octets) + check(FaultKind::Buffer)),
            ("cache", None, 8 * u64::from(config.cache.octets)),
        ]);
        let (mut lines, mut without_figure) = (Vec::new(), Vec::new());
        let mut sums = [0_u64; 4];
        for (item, bits, count) in items.filter(|(_, _, count)| *count != 0) {
            let Some(price) = pricing.price(item) else {
                without_figure.push(item);
                continue;
            };
            let each = price.figures[Width::Word as usize];
            let all = each.saturating_mul(count);
            let part = ["register", "buffer", "cache"].iter().position(|part| *part == item).map_or(0, |at| at + 1);
            sums[part] = sums[part].saturating_add(all);
            lines.push(AreaLine {
                item,
                bits,
                count,
                each_um2: micrometres(each),
                um2: micrometres(all),
                formula: price.formula,
                source: price.source,
                is_derived: price.is_derived,
            });
        }
        let core = sums.iter().fold(0_u64, |sum, part| sum.saturating_add(*part));
        let [units_um2, registers_um2, buffer_um2, cache_um2] = sums.map(micrometres);
        TableArea {
            table: pricing.table.name,
            technology: pricing.table.technology,
            units_um2,
            registers_um2,
            buffer_um2,
            cache_um2,
            core_um2: micrometres(core),
            cores_um2: micrometres(core.saturating_mul(config.cores.into())),
            lines,
            without_figure,
        }
    }
}

#[cfg(test)]
mod tests {
    use emu::machine::config::formula::Dimension;

    use super::*;

    #[test]
    fn the_area_of_a_core_by_hand() {
        let config = Config { buffer_octets: 100, ..Config::default() };
        let pricing = Pricing::all(&config, Dimension::Area);
        let area = TableArea::new(&pricing[1], &config);
        // An adder and a subtractor of 278, a multiplier of 6,350, a comparator of 71, and a divider of a subtractor and a comparator.
        assert_eq!(area.units_um2, 278.0 + 278.0 + 6350.0 + 71.0 + 278.0 + 71.0);
        // 31 x 32 + 32 x 96 + 8 x 64 = 4,576 bits of 5.98, and 800 bits of the buffer as much each.
        assert_eq!((area.registers_um2, area.buffer_um2), (27_364.48, 4_784.0));
        assert_eq!(format!("{:.6}", area.core_um2), "39474.480000");
        assert_eq!(area.cores_um2, 4.0 * area.core_um2);
        // The other table has no areas, and takes these.
        assert_eq!(TableArea::new(&pricing[0], &config).lines, area.lines);
    }
}
