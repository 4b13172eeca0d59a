//! `[energy]` and `[area]` of a machine file: for each item the published tables' figures, or a figure of the user's.

use std::collections::BTreeMap;
use std::fmt;

use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::formula::{Dimension, FigureLine};
use super::published::PUBLISHED;

/// Key of the tables that all items go by.
const TABLES: &str = "tables";

/// Text of an item for which nothing is counted.
const NOTHING: &str = "none";

/// Items of `[energy]`, with what each figure is for.
pub const ENERGY_ITEMS: [(&str, &str); 14] = [
    ("add", "an addition of b bits"),
    ("address", "an addition of addresses, of 32 bits"),
    ("buffer", "a bit that is read from or written to a core's buffer, L = log2 of its bits"),
    ("bus", "a bit that goes over the bus"),
    ("cache", "a bit that is read from or filled into a cache, L = log2 of its bits"),
    ("cmp", "a comparison of b bits"),
    ("div", "a division of b bits"),
    ("jump", "a jump, call or return"),
    ("logic", "a logical operation or shift of b bits"),
    ("memory", "a bit that is read from or written to global memory"),
    ("move", "a copy or constant, apart from its registers"),
    ("mul", "a multiplication of b by b bits"),
    ("register", "a bit that an instruction reads from or writes to a register"),
    ("sub", "a subtraction or negation of b bits"),
];

/// Items of `[area]`, with what each figure is for.
pub const AREA_ITEMS: [(&str, &str); 8] = [
    ("add", "an adder of b bits"),
    ("buffer", "a bit of a core's buffer, L = log2 of its bits"),
    ("cache", "a bit of a cache, L = log2 of its bits"),
    ("cmp", "a comparator of b bits"),
    ("div", "a divider of b bits"),
    ("mul", "a multiplier of b by b bits"),
    ("register", "a bit of a register"),
    ("sub", "a subtractor of b bits"),
];

/// Choice of a figure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LineChoice {
    /// As the key `tables` says.
    AsTables,
    /// Figures of published tables, by their places in [`PUBLISHED`], at least one.
    Tables(Vec<usize>),
    /// Nothing is counted.
    Nothing,
    /// A figure of the user's, which holds beside every table.
    Own(FigureLine),
}

impl LineChoice {
    fn parse(text: &str, dimension: Dimension) -> Result<LineChoice, String> {
        match text.trim() {
            TABLES => return Ok(LineChoice::AsTables),
            NOTHING => return Ok(LineChoice::Nothing),
            text if text.contains(';') || text.contains(|c: char| c.is_ascii_digit()) => {
                return FigureLine::parse(text, dimension).map(LineChoice::Own);
            }
            _ => {}
        }
        let mut tables = Vec::new();
        for name in text.split(',').map(str::trim) {
            let names = || PUBLISHED.iter().map(|table| format!("`{}`", table.name)).collect::<Vec<_>>().join(", ");
            let place = PUBLISHED.iter().position(|table| table.name == name).ok_or_else(|| {
                format!("unknown table `{name}`, expected one of {}, `{TABLES}`, `{NOTHING}` or a figure with unit and source", names())
            })?;
            if !tables.contains(&place) {
                tables.push(place);
            }
        }
        Ok(LineChoice::Tables(tables))
    }
}

impl fmt::Display for LineChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LineChoice::AsTables => f.write_str(TABLES),
            LineChoice::Nothing => f.write_str(NOTHING),
            LineChoice::Own(line) => line.fmt(f),
            LineChoice::Tables(tables) => {
                let names: Vec<&str> = tables.iter().map(|&place| PUBLISHED[place].name).collect();
                f.write_str(&names.join(", "))
            }
        }
    }
}

/// One choice an item, written as a table of texts; items that it leaves out go by the published tables.
macro_rules! line_table {
    ($(#[doc = $doc:literal])* $type:ident $entry:ident $dimension:ident $items:ident) => {
        $(#[doc = $doc])*
        #[derive(Clone, Debug, PartialEq, Eq)]
        pub struct $type {
            /// Published tables that items go by, by their places in [`PUBLISHED`].
            pub tables: Vec<usize>,
            lines: [LineChoice; $items.len()],
        }

        impl $type {
            /// Choice of an item; `None` for a name that is none.
            pub fn line(&self, item: &str) -> Option<&LineChoice> {
                Some(&self.lines[$items.iter().position(|(name, _)| *name == item)?])
            }
        }

        impl Default for $type {
            fn default() -> $type {
                $type { tables: (0..PUBLISHED.len()).collect(), lines: [const { LineChoice::AsTables }; $items.len()] }
            }
        }

        impl TryFrom<BTreeMap<String, $entry>> for $type {
            type Error = String;

            fn try_from(table: BTreeMap<String, $entry>) -> Result<$type, String> {
                let mut all = $type::default();
                for (name, $entry(choice)) in table {
                    if name == TABLES {
                        all.tables = match choice {
                            LineChoice::Tables(tables) => tables,
                            other => return Err(format!("`{TABLES}` names published tables, which `{other}` does not")),
                        };
                        continue;
                    }
                    let names = || $items.iter().map(|(name, _)| format!("`{name}`")).collect::<Vec<_>>().join(", ");
                    let place = $items.iter().position(|(known, _)| *known == name);
                    let place = place.ok_or_else(|| format!("unknown item `{name}`, expected `{TABLES}` or one of {}", names()))?;
                    all.lines[place] = choice;
                }
                Ok(all)
            }
        }

        impl Serialize for $type {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                let lines = $items.iter().zip(&self.lines).map(|((name, _), choice)| (*name, choice.to_string()));
                let tables = LineChoice::Tables(self.tables.clone()).to_string();
                serializer.collect_map(lines.chain([(TABLES, tables)]))
            }
        }

        impl<'de> Deserialize<'de> for $type {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<$type, D::Error> {
                let table = BTreeMap::<String, $entry>::deserialize(deserializer)?;
                table.try_into().map_err(D::Error::custom)
            }
        }

        /// An item's value.
        #[derive(Debug)]
        struct $entry(LineChoice);

        impl<'de> Deserialize<'de> for $entry {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<$entry, D::Error> {
                deserializer.deserialize_str(ChoiceVisitor(Dimension::$dimension)).map($entry)
            }
        }
    };
}

line_table! {
    /// Figures of energy.
    EnergyConfig EnergyEntry Energy ENERGY_ITEMS
}

line_table! {
    /// Figures of area.
    AreaConfig AreaEntry Area AREA_ITEMS
}

struct ChoiceVisitor(Dimension);

impl Visitor<'_> for ChoiceVisitor {
    type Value = LineChoice;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = if self.0 == Dimension::Energy { "pJ" } else { "um2" };
        write!(f, "a text such as \"0.003 b {unit}; my synthesis\"")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<LineChoice, E> {
        LineChoice::parse(text, self.0).map_err(E::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_stand_in_the_order_of_files() {
        assert!(ENERGY_ITEMS.is_sorted() && AREA_ITEMS.is_sorted());
    }

    #[test]
    fn choices_read_back_as_themselves() {
        for text in ["tables", "none", "horowitz", "aladdin, horowitz", "0.21/32 b pJ; a paper, table 2"] {
            assert_eq!(LineChoice::parse(text, Dimension::Energy).expect(text).to_string(), text);
        }
        let error = LineChoice::parse("horrowitz", Dimension::Energy).unwrap_err();
        assert!(error.contains("unknown table `horrowitz`, expected one of `horowitz`"), "{error}");
    }
}
