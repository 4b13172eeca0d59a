//! Published figures of energy and area. Each line has its source; what a table lacks is taken from another one.

use std::sync::LazyLock;

use super::formula::{Dimension, FigureLine};

/// A published table.
#[derive(Debug)]
pub struct PublishedTable {
    /// Name in machine files.
    pub name: &'static str,
    /// Process for which its figures are.
    pub technology: &'static str,
    /// Energies by item.
    energy: &'static [(&'static str, &'static str)],
    /// Areas by item.
    area: &'static [(&'static str, &'static str)],
    lines: LazyLock<Vec<(Dimension, &'static str, FigureLine)>>,
}

impl PublishedTable {
    /// The table's line of an item; `None` where it has none.
    pub fn line(&self, dimension: Dimension, item: &str) -> Option<&FigureLine> {
        self.lines.iter().find(|(of, name, _)| *of == dimension && *name == item).map(|(_, _, line)| line)
    }
}

macro_rules! read {
    ($table:expr) => {
        LazyLock::new(|| {
            let table: &PublishedTable = &$table;
            let parts = [(Dimension::Energy, table.energy), (Dimension::Area, table.area)];
            let lines =
                parts.into_iter().flat_map(|(of, lines)| lines.iter().map(move |&(name, text)| (of, name, text)));
            lines.map(|(of, name, text)| (of, name, FigureLine::parse(text, of).expect("tables are right"))).collect()
        })
    };
}

static HOROWITZ: PublishedTable = PublishedTable {
    name: "horowitz",
    technology: "45 nm",
    energy: &[
        (
            "add",
            "0.003125 b pJ; Horowitz, ISSCC 2014, 45 nm, as fitted in google/qkeras (qtools/config_public.py, fpm_add)",
        ),
        ("sub", "0.003125 b pJ; as add: Horowitz, ISSCC 2014, 45 nm, as fitted in google/qkeras (fpm_add)"),
        ("cmp", "0.003125 b pJ; as add: Horowitz, ISSCC 2014, 45 nm, as fitted in google/qkeras (fpm_add)"),
        (
            "mul",
            "0.002994791667 b^2 + 0.001041666667 b pJ; Horowitz, ISSCC 2014, 45 nm, as fitted in google/qkeras (qtools/config_public.py, fpm_mul)",
        ),
        (
            "buffer",
            "0.000902427321 L^3 - 0.0268847858 L^2 + 0.208900804 L pJ; Horowitz, ISSCC 2014, 45 nm, as fitted in google/qkeras (sram_rd), a bit read; writes as reads",
        ),
        (
            "cache",
            "0.000902427321 L^3 - 0.0268847858 L^2 + 0.208900804 L pJ; Horowitz, ISSCC 2014, 45 nm, as fitted in google/qkeras (sram_rd), a bit read; writes as reads",
        ),
        (
            "memory",
            "20.3125 pJ; Horowitz, ISSCC 2014, DRAM, as fitted in google/qkeras (dram_rd: 650 pJ for 32 bits), a bit read; writes as reads",
        ),
    ],
    area: &[],
    lines: read!(HOROWITZ),
};

static ALADDIN: PublishedTable = PublishedTable {
    name: "aladdin",
    technology: "40 nm",
    energy: &[
        ("add", "0.21/32 b pJ; Aladdin, 40 nm, as in hwcomponents-library 1.0.58: 0.21 pJ at 32 bits, linear"),
        ("sub", "0.21/32 b pJ; as add: Aladdin, 40 nm, as in hwcomponents-library 1.0.58"),
        ("cmp", "0.0295/32 b pJ; Aladdin, 40 nm, as in hwcomponents-library 1.0.58: 0.0295 pJ at 32 bits, linear"),
        (
            "mul",
            "12.68/1024 b^2 pJ; Aladdin, 40 nm, as in hwcomponents-library 1.0.58: 12.68 pJ at 32 x 32 bits, by the product of the widths",
        ),
        ("register", "0.009 pJ; Aladdin, 40 nm, as in hwcomponents-library 1.0.58, a bit read or written"),
    ],
    area: &[
        ("add", "278/32 b um2; Aladdin, 40 nm, as in hwcomponents-library 1.0.58: 278 um2 at 32 bits, linear"),
        ("sub", "278/32 b um2; as add: Aladdin, 40 nm, as in hwcomponents-library 1.0.58"),
        ("cmp", "71/32 b um2; Aladdin, 40 nm, as in hwcomponents-library 1.0.58: 71 um2 at 32 bits, linear"),
        (
            "mul",
            "6350/1024 b^2 um2; Aladdin, 40 nm, as in hwcomponents-library 1.0.58: 6,350 um2 at 32 x 32 bits, by the product of the widths",
        ),
        ("register", "5.98 um2; Aladdin, 40 nm, as in hwcomponents-library 1.0.58, a bit"),
    ],
    lines: read!(ALADDIN),
};

/// All tables, in the order in which they are shown.
pub static PUBLISHED: [&PublishedTable; 2] = [&HOROWITZ, &ALADDIN];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_have_the_figures_that_were_published() {
        // Attojoules of an operation on 8 and 32 bits.
        for (table, item, at_8, at_32) in [
            (0, "add", 25_000, 100_000),
            (0, "mul", 200_000, 3_100_000),
            (1, "add", 52_500, 210_000),
            (1, "cmp", 7_375, 29_500),
            (1, "mul", 792_500, 12_680_000),
        ] {
            let line = PUBLISHED[table].line(Dimension::Energy, item).expect(item);
            assert_eq!([line.at(8, 1), line.at(32, 1)], [Some(at_8), Some(at_32)], "{item}");
        }
        let area = |item| ALADDIN.line(Dimension::Area, item).and_then(|line| line.at(32, 1));
        assert_eq!(
            ["add", "cmp", "mul", "register"].map(area),
            [278, 71, 6350, 0].map(|um2| Some(um2 * 1_000_000 + if um2 == 0 { 5_980_000 } else { 0 }))
        );
        assert!(PUBLISHED.iter().all(|table| table.line(Dimension::Energy, "div").is_none()));
    }
}
