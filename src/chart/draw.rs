//! A figure as shapes: title, legend and plots from the top down, each plot with its grid, axes, lines, marks and names.

use super::canvas::{Canvas, PagePlace, TextAnchor, TextLine};
use super::font;
use super::label::{LabelBox, LabelPlacer};
use super::page::{EDGE, Page, TEXT};
use super::scale::AxisScale;
use super::style::{self, ChartColumns, ChartStyle, MARK};
use super::{AxisKind, ChartAxis, ChartFigure, ChartLine, ChartSeries, Plot};

/// Size of small letters in points.
const SMALL: f64 = 6.5;

/// Room between parts, in points.
const GAP: f64 = 5.0;

/// Length of a line in the legend.
const SAMPLE: f64 = 18.0;

/// Half the length of the lines across the ends of a bar, in points.
const CAP: f64 = 1.6;

/// Distance that names of ticks keep.
const TICK_GAP: f64 = 5.0;

/// A figure on its page. The page is as high as what stands on it.
pub(super) fn figure(figure: &ChartFigure, style: ChartStyle) -> Canvas {
    let mut page = Page::new(&figure.title, &figure.note, style);
    page.legend(figure);
    for row in &figure.rows {
        match style.columns {
            ChartColumns::One => row.iter().for_each(|plot| page.row(std::slice::from_ref(plot))),
            ChartColumns::Two => page.row(row),
        }
    }
    page.finish()
}

impl Page {
    fn words(&mut self, at: PagePlace, anchor: TextAnchor, size: f64, words: &str) {
        let colour = self.style.theme.ink();
        let words = words.to_owned();
        self.canvas.text(TextLine { at, anchor, size, is_bold: false, is_turned: false, colour, words });
    }

    /// A sample of each name's line and mark, in rows above all plots, so that no curve runs under it.
    fn legend(&mut self, figure: &ChartFigure) {
        let mut named: Vec<&ChartSeries> = Vec::new();
        for series in figure.rows.iter().flatten().flat_map(|plot| &plot.series) {
            if !series.name.is_empty() && !named.iter().any(|known| known.name == series.name) {
                named.push(series);
            }
        }
        if named.is_empty() {
            return;
        }
        let (mut x, right) = (EDGE, self.canvas.size.0 - EDGE);
        self.y += GAP + TEXT;
        for series in named {
            let sample = if series.line == ChartLine::None { 2.0 * MARK } else { SAMPLE };
            let length = sample + 4.0 + font::width(&series.name, TEXT, false);
            if x > EDGE && x + length > right {
                (x, self.y) = (EDGE, self.y + 1.5 * TEXT);
            }
            let middle = self.y - 0.35 * TEXT;
            self.series_line(vec![(x, middle), (x + sample, middle)], series);
            if series.is_marked {
                let mark = style::mark(series.look, (x + sample / 2.0, middle));
                self.canvas.area(mark, self.style.theme.of(series.look), "");
            }
            self.words((x + sample + 4.0, self.y), TextAnchor::Start, TEXT, &series.name);
            x += length + 12.0;
        }
        self.y += GAP;
    }

    fn series_line(&mut self, points: Vec<PagePlace>, series: &ChartSeries) {
        let width = match series.line {
            ChartLine::None => return,
            ChartLine::Solid => 1.3,
            ChartLine::Dashed | ChartLine::Dotted => 1.0,
        };
        self.canvas.line(points, self.style.theme.of(series.look), width, style::dashes(series.line));
    }

    /// Plots side by side.
    fn row(&mut self, plots: &[Plot]) {
        let whole = self.canvas.size.0 - 2.0 * EDGE;
        let width = (whole - 2.0 * EDGE * (plots.len() - 1) as f64) / plots.len().max(1) as f64;
        let top = self.y + GAP;
        let mut bottom = top;
        for (at, plot) in (0..).zip(plots) {
            let left = EDGE + f64::from(at) * (width + 2.0 * EDGE);
            self.y = top;
            self.plot(plot, left, width);
            bottom = f64::max(bottom, self.y);
        }
        self.y = bottom;
    }

    /// One plot from the page's height on.
    fn plot(&mut self, plot: &Plot, left: f64, width: f64) {
        if !plot.title.is_empty() {
            self.y += TEXT * 1.2;
            self.words((left, self.y), TextAnchor::Start, TEXT, &plot.title);
        }
        let top = self.y + TEXT;
        let height = (width * plot.aspect).max(70.0);
        let numbers =
            |value: fn(&super::ChartPoint) -> f64| plot.series.iter().flat_map(|series| &series.points).map(value);
        // The names of the upward axis decide how much room is left for the one to the right.
        let rows = ((height / 26.0) as usize).clamp(2, 8);
        let ends =
            plot.series.iter().flat_map(|series| &series.points).flat_map(|point| point.bar.into_iter().flatten());
        let up = AxisScale::new(&plot.y.kind, numbers(|point| point.y).chain(ends), rows);
        let ticks_up = apart(up.ticks(rows), |place| height * up.place(place), |_| SMALL);
        let widest = ticks_up.iter().map(|(_, name)| font::width(name, SMALL, false)).fold(0.0, f64::max);
        let start = left + TEXT * 1.3 + widest + 4.0;
        // Half of the last tick's name stands beyond the axis.
        let right = left + width - 10.0;
        let columns = (((right - start) / 45.0) as usize).clamp(2, 10);
        let across = AxisScale::new(&plot.x.kind, numbers(|point| point.x), columns);
        let frame = PlotFrame { start, right, top, bottom: top + height, across, up };
        let under = self.axes(plot, &frame, left, &ticks_up, columns);
        self.contents(plot, &frame);
        self.y = under + GAP;
    }

    /// Grid, ticks and names of both axes; yields the height at which they end.
    fn axes(&mut self, plot: &Plot, frame: &PlotFrame, left: f64, ticks_up: &[(f64, String)], columns: usize) -> f64 {
        let (theme, PlotFrame { start, right, top, bottom, .. }) = (self.style.theme, frame);
        for (tick, name) in ticks_up {
            let y = frame.y(*tick);
            self.canvas.line(vec![(*start, y), (*right, y)], theme.grid(), 0.5, &[]);
            self.words((start - 4.0, y + 0.35 * SMALL), TextAnchor::End, SMALL, name);
        }
        let all = frame.across.ticks(columns);
        let width = |name: &str| font::width(name, SMALL, false);
        let is_named = matches!(plot.x.kind, AxisKind::Names(_));
        let shown = apart(all.clone(), |tick| frame.x(tick), width);
        // Names that do not fit side by side stand upright; numbers that do not fit are left out.
        let is_upright = is_named && shown.len() < all.len();
        for (tick, _) in &all {
            let x = frame.x(*tick);
            self.canvas.line(vec![(x, *top), (x, *bottom)], theme.grid(), 0.5, &[]);
        }
        let mut under = bottom + SMALL * 1.4;
        for (tick, name) in if is_upright { &all } else { &shown } {
            let x = frame.x(*tick);
            match is_upright {
                false => self.words((x, under), TextAnchor::Middle, SMALL, name),
                true => self.canvas.text(TextLine {
                    at: (x + 0.35 * SMALL, bottom + 4.0),
                    anchor: TextAnchor::End,
                    size: SMALL,
                    is_bold: false,
                    is_turned: true,
                    colour: theme.ink(),
                    words: name.clone(),
                }),
            }
        }
        if is_upright {
            under = bottom + 4.0 + all.iter().map(|(_, name)| width(name)).fold(0.0, f64::max);
        }
        self.canvas.line(vec![(*start, *top), (*start, *bottom), (*right, *bottom)], theme.ink(), 0.8, &[]);
        self.axis_names(plot, frame, left, &mut under);
        under
    }

    fn axis_names(&mut self, plot: &Plot, frame: &PlotFrame, left: f64, under: &mut f64) {
        let ChartAxis { name, .. } = &plot.x;
        if !name.is_empty() {
            *under += TEXT * 1.3;
            self.words(((frame.start + frame.right) / 2.0, *under), TextAnchor::Middle, TEXT, name);
        }
        self.canvas.text(TextLine {
            at: (left + TEXT * 0.8, (frame.top + frame.bottom) / 2.0),
            anchor: TextAnchor::Middle,
            size: TEXT,
            is_bold: false,
            is_turned: true,
            colour: self.style.theme.ink(),
            words: plot.y.name.clone(),
        });
    }

    /// Lines, marks above all lines, and names beside them.
    fn contents(&mut self, plot: &Plot, frame: &PlotFrame) {
        let theme = self.style.theme;
        let mut lines: Vec<(PagePlace, PagePlace)> = Vec::new();
        for series in &plot.series {
            let points: Vec<PagePlace> = series.points.iter().map(|point| frame.at(point)).collect();
            if series.line != ChartLine::None {
                lines.extend(points.windows(2).map(|pair| (pair[0], pair[1])));
                self.series_line(points, series);
            }
        }
        // Bars stand below all marks, with short lines across their ends.
        for series in &plot.series {
            for point in &series.points {
                let Some([low, high]) = point.bar else { continue };
                let (x, low, high) = (frame.x(point.x), frame.y(low), frame.y(high));
                let colour = theme.of(series.look);
                for line in
                    [[(x, low), (x, high)], [(x - CAP, low), (x + CAP, low)], [(x - CAP, high), (x + CAP, high)]]
                {
                    self.canvas.line(line.to_vec(), colour, 0.6, &[]);
                    lines.push((line[0], line[1]));
                }
            }
        }
        let mut boxes = Vec::new();
        for series in plot.series.iter().filter(|series| series.is_marked) {
            for point in &series.points {
                let at = frame.at(point);
                boxes.push(LabelBox::around(at, MARK + 0.4));
                self.canvas.area(style::mark(series.look, at), theme.of(series.look), &point.tip);
            }
        }
        let inside = LabelBox { low: (frame.start + 1.0, frame.top + 1.0), high: (frame.right, frame.bottom - 1.0) };
        let mut placer = LabelPlacer::new(inside, boxes, lines);
        // Names of series above come first, since those are the ones that the figure is about.
        for series in plot.series.iter().rev() {
            for point in &series.points {
                let Some(label) = &point.label else { continue };
                if self.style.columns == ChartColumns::One && !label.is_important {
                    continue;
                }
                let size = (font::width(&label.words, SMALL, false) + 1.0, SMALL * 1.05);
                let Some(placed) = placer.place(frame.at(point), size) else { continue };
                let colour = theme.of(series.look);
                if let Some((from, to)) = placed.leader {
                    self.canvas.line(vec![from, to], colour, 0.35, &[]);
                }
                let at = (placed.room.low.0 + 0.5, placed.room.high.1 - SMALL * 0.25);
                self.canvas.text(TextLine {
                    at,
                    anchor: TextAnchor::Start,
                    size: SMALL,
                    is_bold: false,
                    is_turned: false,
                    colour,
                    words: label.words.clone(),
                });
            }
        }
    }
}

/// A plot's place on the page, and its axes.
struct PlotFrame {
    start: f64,
    right: f64,
    top: f64,
    bottom: f64,
    across: AxisScale,
    up: AxisScale,
}

impl PlotFrame {
    fn x(&self, number: f64) -> f64 {
        self.start + self.across.place(number) * (self.right - self.start)
    }

    fn y(&self, number: f64) -> f64 {
        self.bottom - self.up.place(number) * (self.bottom - self.top)
    }

    fn at(&self, point: &super::ChartPoint) -> PagePlace {
        (self.x(point.x), self.y(point.y))
    }
}

/// The ticks whose names do not meet that of the one shown before.
fn apart(ticks: Vec<(f64, String)>, place: impl Fn(f64) -> f64, length: impl Fn(&str) -> f64) -> Vec<(f64, String)> {
    let mut end = f64::NEG_INFINITY;
    let mut is_free = |(tick, name): &(f64, String)| {
        let (middle, half) = (place(*tick), length(name) / 2.0);
        let is_free = middle - half >= end;
        if is_free {
            end = middle + half + TICK_GAP;
        }
        is_free
    };
    ticks.into_iter().filter(|tick| is_free(tick)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::canvas::DrawnShape;
    use super::super::{AxisKind, ChartPoint, Look, PointLabel};
    use super::*;

    /// Rooms of all texts that are not turned.
    fn rooms(canvas: &Canvas) -> Vec<(String, LabelBox)> {
        let room = |line: &TextLine| {
            let (x, y) = line.start();
            // Letters reach from a fifth below the base line to three quarters above it.
            let room = LabelBox { low: (x, y - 0.75 * line.size), high: (x + line.width(), y + 0.2 * line.size) };
            (line.words.clone(), room)
        };
        let upright = canvas.shapes.iter().filter_map(|shape| match shape {
            DrawnShape::Text(line) if !line.is_turned => Some(room(line)),
            _ => None,
        });
        upright.collect()
    }

    #[test]
    fn no_texts_of_forty_variants_meet_in_either_width() {
        // Four at each of ten places, as words of four lengths that make hardly a difference.
        let point = |k: u32| ChartPoint {
            label: Some(PointLabel { words: format!("variant {k} of cutoff 0.0078125"), is_important: k < 8 }),
            bar: k.is_multiple_of(5).then_some([15.0 + 14.0 * f64::from(k % 10), 24.0 + 14.0 * f64::from(k % 10)]),
            ..ChartPoint::new(5000.0 + 700.0 * f64::from(k % 10), 20.0 + 14.0 * f64::from(k % 10) + 0.01 * f64::from(k))
        };
        let axis = |name: &str, kind| ChartAxis { name: name.to_owned(), kind };
        let series = |name: &str, line, numbers: std::ops::Range<u32>| ChartSeries {
            name: name.to_owned(),
            look: Look::Numbered(numbers.start as usize % 5),
            line,
            is_marked: true,
            points: numbers.map(point).collect(),
        };
        let plot = Plot {
            title: "a scene".to_owned(),
            x: axis("clocks a pixel", AxisKind::Logarithmic),
            y: axis("PSNR, dB", AxisKind::Linear),
            series: vec![series("some", ChartLine::None, 8..40), series("others", ChartLine::Solid, 0..8)],
            aspect: 0.66,
        };
        let figure =
            ChartFigure { title: "a long title of a figure ".repeat(5), note: String::new(), rows: vec![vec![plot]] };
        // One column names what is important; two name what finds room, and here that is not all of them.
        for (columns, names) in [(ChartColumns::One, 8..=8), (ChartColumns::Two, 30..=40)] {
            let canvas = super::figure(&figure, ChartStyle { columns, ..ChartStyle::default() });
            let rooms = rooms(&canvas);
            let shown = rooms.iter().filter(|(words, _)| words.starts_with("variant")).count();
            assert!(names.contains(&shown), "{columns:?}: {shown}");
            for (at, (words, room)) in rooms.iter().enumerate() {
                let met = rooms[..at].iter().find(|(_, other)| other.meets(room));
                assert!(met.is_none(), "{columns:?}: `{words}` meets {met:?}");
                assert!(room.low.0 >= 0.0 && room.high.0 <= canvas.size.0, "{columns:?}: `{words}` leaves the page");
            }
        }
    }
}
