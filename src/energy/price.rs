//! Prices of a machine's items by a published table and the machine's own lines, each with its source.

use emu::inject::{FaultKind, Protection};
use emu::machine::Config;
use emu::machine::config::formula::{Dimension, FigureLine};
use emu::machine::config::ledger::LineChoice;
use emu::machine::config::protection::WORD_BITS;
use emu::machine::config::published::{PUBLISHED, PublishedTable};
use isa::Class;

use super::activity::{Activity, INTEGER_BITS, Width};

/// Price of an item.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ItemPrice {
    /// Name of the item, as a machine file has it.
    pub item: &'static str,
    /// Attojoules or square nanometres of one, by [`Width`]; all the same where the item has no width of its own.
    pub figures: [u64; Width::ALL.len()],
    /// Formula and unit, as they are written.
    pub formula: String,
    /// Source of the figure.
    pub source: String,
    /// True where no line was published, so that the figure is put together from others.
    pub is_derived: bool,
}

/// A published table on a machine.
#[derive(Clone, Copy, Debug)]
pub struct Pricing<'c> {
    config: &'c Config,
    dimension: Dimension,
    /// The table.
    pub table: &'static PublishedTable,
}

impl<'c> Pricing<'c> {
    /// Pricings of energy or area by each table that the machine names.
    pub fn all(config: &'c Config, dimension: Dimension) -> Vec<Pricing<'c>> {
        let tables = match dimension {
            Dimension::Energy => &config.energy.tables,
            Dimension::Area => &config.area.tables,
        };
        tables.iter().map(|&place| Pricing { config, dimension, table: PUBLISHED[place] }).collect()
    }

    /// Bits of a word of the machine.
    pub fn word(&self) -> u32 {
        self.config.arithmetic.word
    }

    /// The line of an item: the machine's own, the table's, or that of another table; `None` where nobody has one.
    fn line(&self, item: &str) -> Option<&'c FigureLine> {
        let config = self.config;
        let choice = match self.dimension {
            Dimension::Energy => config.energy.line(item),
            Dimension::Area => config.area.line(item),
        };
        let tables: Vec<&'static PublishedTable> = match choice? {
            LineChoice::Own(line) => return Some(line),
            LineChoice::Nothing => return None,
            LineChoice::AsTables => vec![self.table],
            LineChoice::Tables(places) => places.iter().map(|&place| PUBLISHED[place]).collect(),
        };
        let mut first =
            tables.iter().copied().filter(|table| std::ptr::eq(*table, self.table)).chain(tables.iter().copied());
        let named = first.find_map(|table| table.line(self.dimension, item));
        named.or_else(|| PUBLISHED.iter().find_map(|table| table.line(self.dimension, item)))
    }

    /// Nothing is to be counted for an item, as the machine's file says.
    fn is_left_out(&self, item: &str) -> bool {
        let choice = match self.dimension {
            Dimension::Energy => self.config.energy.line(item),
            Dimension::Area => self.config.area.line(item),
        };
        choice == Some(&LineChoice::Nothing)
    }

    /// Bits of the memory that a bit of an item is in; 1 for what is no memory.
    fn memory_bits(&self, item: &str) -> u64 {
        match item {
            "buffer" => 8 * u64::from(self.config.buffer_octets),
            "cache" => 8 * u64::from(self.config.cache.octets),
            _ => 1,
        }
    }

    /// Price of an item; `None` where there is no line and nothing that it could be derived from.
    pub fn price(&self, item: &'static str) -> Option<ItemPrice> {
        let word = self.config.arithmetic.word;
        let figures = |line: &FigureLine| {
            let at = |width: Width| line.at(width.bits(word), self.memory_bits(item));
            let [a, b, c] = Width::ALL.map(at);
            Some([a?, b?, c?])
        };
        match self.line(item) {
            Some(line) => Some(ItemPrice {
                item,
                figures: figures(line)?,
                formula: line.formula().to_owned(),
                source: line.source().to_owned(),
                is_derived: false,
            }),
            None if self.is_left_out(item) => None,
            None => self.derived(item),
        }
    }

    /// Price of an item without a line, from those of others.
    fn derived(&self, item: &'static str) -> Option<ItemPrice> {
        let made = |figures, formula: &str, source: String| {
            Some(ItemPrice { item, figures, formula: formula.to_owned(), source, is_derived: true })
        };
        let word = self.config.arithmetic.word;
        match (item, self.dimension) {
            ("div", dimension) => {
                let (sub, cmp) = (self.price("sub")?, self.price("cmp")?);
                let step = |at: usize| sub.figures[at] + cmp.figures[at];
                let sources = format!("sub: {}; cmp: {}", sub.source, cmp.source);
                match dimension {
                    // With 100 aJ for a subtraction and 60 aJ for a comparison, a word of 32 bits takes 32 * 160 = 5,120 aJ.
                    Dimension::Energy => {
                        let steps = |width: Width| u64::from(width.bits(word)) * step(width as usize);
                        let source = format!(
                            "derived: no published line; b bit-serial steps, each a subtraction and a comparison ({sources})"
                        );
                        made(Width::ALL.map(steps), "b (sub + cmp)", source)
                    }
                    // All steps share one unit, so its area does not grow with their number.
                    Dimension::Area => {
                        let source = format!(
                            "derived: no published line; a subtractor and a comparator, used a step a bit ({sources})"
                        );
                        made(Width::ALL.map(|width| step(width as usize)), "sub + cmp", source)
                    }
                }
            }
            // Addresses are integers of 32 bits whatever the word, so all widths have one price.
            ("address", Dimension::Energy) => {
                let add = self.price("add")?;
                let source = format!("derived: an addition of {INTEGER_BITS} bits ({})", add.source);
                made([add.figures[Width::Integer as usize]; 3], "add", source)
            }
            ("buffer" | "cache", Dimension::Area) => {
                let register = self.price("register")?;
                let source = format!(
                    "derived: no published line; as bits of registers, which is an upper bound ({})",
                    register.source
                );
                made(register.figures, "register", source)
            }
            _ => None,
        }
    }

    /// Prices of energy, as an activity meets them: those of bits with their check bits, those of operations with what checks them.
    pub fn prices(&self) -> Prices {
        // A residue unit works on two bits beside each word, and an operation that is executed twice costs as much again.
        let results = match self.protection(FaultKind::Results) {
            Protection::Duplicated => (1, 1),
            residue => (residue.check_bits(), self.word()),
        };
        // As their clocks, that is of elementary operations alone: nobody computes an address, a copy or a jump twice.
        let class = |class: Class| match class.is_elementary() {
            true => self.protected(class_item(class)?, &[FaultKind::Results], results),
            false => self.price(class_item(class)?),
        };
        let bits = |item, kinds: &[FaultKind]| {
            let check = kinds.iter().map(|&kind| self.protection(kind).check_bits()).sum();
            self.protected(item, kinds, (check, WORD_BITS))
        };
        Prices {
            classes: std::array::from_fn(|at| class(Class::ALL[at])),
            register: bits("register", &[FaultKind::Registers]),
            buffer: bits("buffer", &[FaultKind::Buffer]),
            cache: self.price("cache"),
            bus: bits("bus", &[FaultKind::Memory, FaultKind::Bus]),
            memory: bits("memory", &[FaultKind::Memory]),
        }
    }

    fn protection(&self, kind: FaultKind) -> Protection {
        self.config.protection.of(kind)
    }

    /// Price of an item whose protections add a share, each figure rounded to the nearest whole one, and its formula with that factor.
    ///
    /// A bit of a register for 9,000 aJ with a bit of parity beside each 32 comes to 9,000 * 33 / 32 = 9,281.25, so it is 9,281 by `33/32 x (9000 aJ)`.
    fn protected(&self, item: &'static str, kinds: &[FaultKind], (part, whole): (u32, u32)) -> Option<ItemPrice> {
        let mut price = self.price(item)?;
        if part != 0 {
            let factor = match (whole + part) % whole {
                0 => format!("{}", (whole + part) / whole),
                _ => format!("{}/{whole}", whole + part),
            };
            price.formula = format!("{factor} x ({})", price.formula);
            let (part, whole) = (u128::from(part), u128::from(whole));
            let with = |figure: u64| (u128::from(figure) * (2 * (whole + part)) + whole) / (2 * whole);
            price.figures = price.figures.map(|figure| with(figure).try_into().unwrap_or(u64::MAX));
            let names = kinds.iter().map(|&kind| self.protection(kind)).filter(|one| *one != Protection::Unprotected);
            let names: Vec<&str> = names.map(Protection::name).collect();
            price.source = format!("{}; protected by {}", price.source, names.join(" and "));
        }
        Some(price)
    }
}

/// The item that prices a class; `None` for classes whose bits are priced instead.
pub fn class_item(class: Class) -> Option<&'static str> {
    match class {
        Class::Mem | Class::Octet | Class::Local => None,
        class => Some(class.name()),
    }
}

/// Energies of everything that an activity consists of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Prices {
    /// Of an operation of each class.
    pub classes: [Option<ItemPrice>; Class::ALL.len()],
    /// Of a bit of a register.
    pub register: Option<ItemPrice>,
    /// Of a bit of a buffer.
    pub buffer: Option<ItemPrice>,
    /// Of a bit of a cache.
    pub cache: Option<ItemPrice>,
    /// Of a bit on the bus.
    pub bus: Option<ItemPrice>,
    /// Of a bit of global memory.
    pub memory: Option<ItemPrice>,
}

/// The figure of an item whose width does not matter; nothing where it has no price.
pub fn figure(price: Option<&ItemPrice>) -> i128 {
    price.map_or(0, |price| price.figures[0].into())
}

impl Prices {
    /// Attojoules of an activity, all octets over the bus and none from a cache.
    pub fn energy(&self, activity: &Activity) -> i128 {
        let mut sum = 0;
        for (price, counts) in self.classes.iter().zip(&activity.operations) {
            let Some(price) = price else { continue };
            sum += counts
                .iter()
                .zip(price.figures)
                .map(|(&count, figure)| i128::from(count) * i128::from(figure))
                .sum::<i128>();
        }
        let memory = i128::from(8 * activity.memory_octets);
        sum + i128::from(activity.register_bits) * figure(self.register.as_ref())
            + i128::from(activity.buffer_bits) * figure(self.buffer.as_ref())
            + memory * figure(self.memory.as_ref())
            + (memory + i128::from(8 * activity.message_octets)) * figure(self.bus.as_ref())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn protected_items_cost_what_they_take_in_addition() {
        let other = ["address", "jump", "logic", "move"].map(|item| format!("{item} = \"70 aJ; by hand\"\n")).concat();
        let energy = "add = \"64 aJ; by hand\"\nbus = \"640 aJ; by hand\"\nmemory = \"3200 aJ; by hand\"\nregister = \"9000 aJ; by hand\"\n";
        let source = messages::Source::new("m.toml", format!("[energy]\n{energy}{other}"));
        let plain = Config::parse(&source).unwrap();
        let figures = |protections: &[(FaultKind, Protection)]| {
            let mut config = plain.clone();
            protections.iter().for_each(|&(kind, protection)| config.protection.set(kind, protection));
            let prices = Pricing::all(&config, Dimension::Energy)[0].prices();
            let add = prices.classes[Class::Add as usize].clone().unwrap();
            // What is not executed twice, and has no residue, costs the same on every machine.
            for class in [Class::Address, Class::Jump, Class::Logic, Class::Move] {
                let price = prices.classes[class as usize].as_ref().unwrap();
                assert_eq!((price.figures[0], price.formula.as_str()), (70, "70 aJ"), "{}", class.name());
            }
            for bit in [&prices.register, &prices.memory, &prices.bus].map(|bit| bit.as_ref().unwrap()) {
                let is_other = ["9000 aJ", "3200 aJ", "640 aJ"].contains(&bit.formula.as_str());
                assert_eq!(is_other, !bit.source.contains("protected"), "{bit:?}");
            }
            let bits = [prices.register, prices.memory, prices.bus].map(|price| figure(price.as_ref()));
            (add, bits)
        };
        let (add, bits) = figures(&[]);
        assert_eq!((add.figures[0], bits, add.source.as_str()), (64, [9_000, 3_200, 640], "by hand"));
        // 9,000 * 33 / 32 = 9,281.25; 3,200 and 640 with 7 bits beside each 32, and the bus with 1 more.
        let (add, bits) =
            figures(&[(FaultKind::Registers, Protection::Parity), (FaultKind::Memory, Protection::Secded)]);
        assert_eq!((add.figures[0], bits), (64, [9_281, 3_900, 780]));
        let (_, bits) = figures(&[(FaultKind::Bus, Protection::Parity), (FaultKind::Memory, Protection::Secded)]);
        assert_eq!(bits, [9_000, 3_900, 800]);
        // Twice; and two bits of 32 in addition.
        let (add, _) = figures(&[(FaultKind::Results, Protection::Duplicated)]);
        let shown = |add: &ItemPrice| (add.figures[0], add.formula.clone(), add.source.clone());
        let wanted = |each, formula: &str, source: &str| (each, formula.to_owned(), source.to_owned());
        assert_eq!(shown(&add), wanted(128, "2 x (64 aJ)", "by hand; protected by duplicated"));
        let (add, _) = figures(&[(FaultKind::Results, Protection::Residue)]);
        assert_eq!(shown(&add), wanted(68, "34/32 x (64 aJ)", "by hand; protected by residue"));
    }
}
