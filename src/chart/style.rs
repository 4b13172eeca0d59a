//! Widths, colours and marks of charts.

use super::canvas::{Colour, PagePlace};
use super::{ChartLine, Look};

/// Width of a chart on paper.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ChartColumns {
    /// One column of two: 252 points, 3.5 inches.
    One,
    /// Both columns: 516 points, 7.17 inches.
    #[default]
    Two,
}

impl ChartColumns {
    /// Width in points of 1/72 inch.
    pub const fn points(self) -> f64 {
        match self {
            ChartColumns::One => 252.0,
            ChartColumns::Two => 516.0,
        }
    }
}

/// Colours of a chart as a whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum ChartTheme {
    /// Dark on white, for paper.
    #[default]
    Light,
    /// Light on dark, for screens.
    Dark,
}

/// Look of a chart beside what it shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ChartStyle {
    /// Width on paper.
    pub columns: ChartColumns,
    /// Colours.
    pub theme: ChartTheme,
}

const fn colour(rgb: u32) -> Colour {
    Colour([(rgb >> 16) as u8, (rgb >> 8) as u8, rgb as u8])
}

/// Looks that differ; the next one is the first again.
const LOOKS: usize = 8;

/// Colours that readers with any colour vision tell apart (Okabe and Ito, 2008), the best on white first.
const ON_WHITE: [Colour; LOOKS] = [
    colour(0x00_72_B2),
    colour(0xD5_5E_00),
    colour(0x00_9E_73),
    colour(0xCC_79_A7),
    colour(0xE6_9F_00),
    colour(0x56_B4_E9),
    colour(0x00_00_00),
    colour(0x8A_5A_2B),
];

/// Such colours for a dark ground, where blue and black are too dark.
const ON_DARK: [Colour; LOOKS] = [
    colour(0x56_B4_E9),
    colour(0xE6_9F_00),
    colour(0x2B_C4_98),
    colour(0xE3_9B_C3),
    colour(0xF0_E4_42),
    colour(0xF0_7F_3C),
    colour(0xFF_FF_FF),
    colour(0xC4_9A_6C),
];

/// Half the width of a mark, in points.
pub(super) const MARK: f64 = 2.6;

impl ChartTheme {
    pub(super) const fn ground(self) -> Colour {
        match self {
            ChartTheme::Light => colour(0xFF_FF_FF),
            ChartTheme::Dark => colour(0x16_19_1D),
        }
    }

    pub(super) const fn ink(self) -> Colour {
        match self {
            ChartTheme::Light => colour(0x20_20_20),
            ChartTheme::Dark => colour(0xE6_E6_E6),
        }
    }

    pub(super) const fn grid(self) -> Colour {
        match self {
            ChartTheme::Light => colour(0xE2_E2_E2),
            ChartTheme::Dark => colour(0x34_38_3E),
        }
    }

    pub(super) const fn muted(self) -> Colour {
        match self {
            ChartTheme::Light => colour(0x80_80_80),
            ChartTheme::Dark => colour(0x92_96_9C),
        }
    }

    pub(super) fn of(self, look: Look) -> Colour {
        match (look, self) {
            (Look::Muted, _) => self.muted(),
            (Look::Numbered(number), ChartTheme::Light) => ON_WHITE[number % ON_WHITE.len()],
            (Look::Numbered(number), ChartTheme::Dark) => ON_DARK[number % ON_DARK.len()],
        }
    }
}

/// Corners of a mark around a place; looks of different numbers have different ones.
pub(super) fn mark(look: Look, (x, y): PagePlace) -> Vec<PagePlace> {
    let round = |corners: u32, turn: f64, size: f64| -> Vec<PagePlace> {
        let angle = |k: u32| std::f64::consts::TAU * (f64::from(k) / f64::from(corners) + turn);
        (0..corners).map(|k| (x + size * angle(k).sin(), y - size * angle(k).cos())).collect()
    };
    // A cross and a plus, arm by arm.
    let arms = |turn: f64| -> Vec<PagePlace> {
        let (a, b) = (1.2 * MARK, 0.36 * MARK);
        let corners = [
            (-b, -a),
            (b, -a),
            (b, -b),
            (a, -b),
            (a, b),
            (b, b),
            (b, a),
            (-b, a),
            (-b, b),
            (-a, b),
            (-a, -b),
            (-b, -b),
        ];
        let (sin, cos) = turn.sin_cos();
        corners.iter().map(|&(u, v)| (x + u * cos - v * sin, y + u * sin + v * cos)).collect()
    };
    match look {
        Look::Muted => round(16, 0.0, 0.8 * MARK),
        Look::Numbered(number) => match number % LOOKS {
            0 => round(20, 0.0, MARK),
            1 => round(4, 0.125, 1.25 * MARK),
            2 => round(3, 0.0, 1.4 * MARK),
            3 => round(4, 0.0, 1.4 * MARK),
            4 => round(3, 0.5, 1.4 * MARK),
            5 => arms(0.0),
            6 => arms(std::f64::consts::FRAC_PI_4),
            _ => round(6, 0.0, 1.1 * MARK),
        },
    }
}

/// Lengths of dashes and gaps, in points; none for a whole line.
pub(super) const fn dashes(line: ChartLine) -> &'static [f64] {
    match line {
        ChartLine::None | ChartLine::Solid => &[],
        ChartLine::Dashed => &[5.0, 2.5],
        ChartLine::Dotted => &[1.2, 2.0],
    }
}
