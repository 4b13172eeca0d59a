//! Options of charts, and the files that they ask for.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::chart::{self, ChartColumns, ChartFigure, ChartStyle, ChartTheme};
use crate::failure::Failure;
use crate::files;

/// Options of charts.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Charts and data")]
pub struct ChartArguments {
    /// Data as comma-separated values.
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Chart as SVG; its data are written beside it, as .csv of the same name, where --csv names no other place.
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Chart as PDF.
    #[arg(long, value_name = "FILE")]
    pub pdf: Option<PathBuf>,
    /// Width of charts on paper: one column (252 points) or two (516).
    #[arg(long, value_name = "1|2", value_parser = columns, default_value = "2")]
    pub columns: ChartColumns,
    /// Colours of charts.
    #[arg(long, value_enum, default_value_t = ChartTheme::Light)]
    pub theme: ChartTheme,
}

fn columns(text: &str) -> Result<ChartColumns, String> {
    match text {
        "1" => Ok(ChartColumns::One),
        "2" => Ok(ChartColumns::Two),
        _ => Err("1 or 2 is expected".to_owned()),
    }
}

/// A file of a chart in the form that its name asks for: .svg or .pdf.
///
/// # Errors
/// Another ending.
pub fn chart_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension().and_then(|end| end.to_str()) {
        Some("svg" | "pdf") => Ok(path),
        _ => Err("a name that ends in .svg or .pdf is expected".to_owned()),
    }
}

impl ChartArguments {
    /// The look that is asked for.
    pub fn style(&self) -> ChartStyle {
        ChartStyle { columns: self.columns, theme: self.theme }
    }

    /// Place of the data: where it was asked for, else beside the first chart.
    fn data(&self) -> Option<PathBuf> {
        // Nothing stands beside standard output.
        let charts = [&self.svg, &self.pdf].into_iter().flatten();
        let mut files = charts.filter(|chart| chart.as_path() != Path::new(files::STANDARD));
        self.csv.clone().or_else(|| files.next().map(|chart| chart.with_extension("csv")))
    }

    /// All files that will be written, with those that a command adds; none may be written twice.
    ///
    /// # Errors
    /// Places that cannot be written, and two results for one file.
    pub fn targets(&self, more: &[&Path]) -> Result<Vec<PathBuf>, Failure> {
        let data = self.data();
        let own = [data.as_ref(), self.svg.as_ref(), self.pdf.as_ref()].into_iter().flatten().cloned();
        let targets: Vec<PathBuf> = own.chain(more.iter().map(|path| path.to_path_buf())).collect();
        files::check_distinct(targets.iter().map(PathBuf::as_path)).map_err(Failure::usage)?;
        for target in &targets {
            files::check_target(target)?;
        }
        Ok(targets)
    }

    /// The files of a chart with its data.
    pub fn files(&self, figure: impl Fn() -> ChartFigure, data: impl Fn() -> String) -> Vec<(PathBuf, Vec<u8>)> {
        let mut files = Vec::new();
        files.extend(self.data().map(|path| (path, data().into_bytes())));
        files.extend(self.svg.clone().map(|path| (path, chart::svg(&figure(), self.style()).into_bytes())));
        files.extend(self.pdf.clone().map(|path| (path, chart::pdf(&figure(), self.style()))));
        files
    }

    /// The file of another chart, in the form that its name asks for.
    pub fn file(&self, path: &Path, figure: &ChartFigure) -> (PathBuf, Vec<u8>) {
        let octets = match path.extension().is_some_and(|end| end == "pdf") {
            true => chart::pdf(figure, self.style()),
            false => chart::svg(figure, self.style()).into_bytes(),
        };
        (path.to_owned(), octets)
    }
}
