//! Tables as people read them. Where a terminal is too narrow for all columns of one, they go below each other in parts,
//! each with the names of the rows.

use tabled::builder::Builder;
use tabled::settings::object::Columns;
use tabled::settings::{Alignment, Style};

use crate::terminal;

/// Columns of the terminal that the border of a table's column takes.
const BORDER: usize = 3;

/// A table: the first row is its head, the first column its names; all other columns stand to the right.
pub fn table<R: IntoIterator<Item = String>>(rows: impl IntoIterator<Item = R>) -> String {
    let rows: Vec<Vec<String>> = rows.into_iter().map(|row| row.into_iter().collect()).collect();
    match terminal::columns() {
        Some(columns) => narrow(&rows, columns),
        None => whole(&rows),
    }
}

/// A table in as many parts as so many columns of the terminal need; cells that are wider than a part are folded.
///
/// For example names of 10 columns and four columns of 20 each, on 60: the first part has two of them (12 + 2 * 23 = 58), the
/// second the other two.
fn narrow(rows: &[Vec<String>], columns: usize) -> String {
    // Where some rows go on without a name, the second column tells them apart.
    let heads = if rows.iter().skip(1).any(|row| row.first().is_some_and(String::is_empty)) { 2 } else { 1 };
    let most = columns.saturating_sub(1 + BORDER * heads) / (heads + 1);
    let longest = |at: usize| rows.iter().filter_map(|row| row.get(at)).map(|cell| cell.chars().count()).max();
    let names: usize = (0..heads).filter_map(longest).map(|width| width.min(most) + BORDER).sum();
    let rest = columns.saturating_sub((names + BORDER).saturating_sub(1));
    let fit = |(at, cell): (usize, &String)| wrapped(cell, if at < heads { most } else { rest });
    let rows: Vec<Vec<String>> = rows.iter().map(|row| row.iter().enumerate().map(fit).collect()).collect();
    let width = |column: usize| {
        let lines = rows.iter().filter_map(|row| row.get(column)).flat_map(|cell| cell.lines());
        lines.map(|line| line.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..rows.iter().map(Vec::len).max().unwrap_or(0)).map(width).collect();
    let names = widths.iter().take(heads).map(|width| width + BORDER).sum::<usize>().saturating_sub(1);
    // Take columns as long as they fit; each part has at least one.
    let mut parts: Vec<Vec<usize>> = Vec::new();
    let mut used = usize::MAX;
    for (column, width) in widths.iter().enumerate().skip(heads) {
        let needed = width + BORDER;
        match parts.last_mut() {
            Some(part) if used.saturating_add(needed) <= columns => {
                part.push(column);
                used += needed;
            }
            _ => {
                parts.push((0..heads).chain([column]).collect());
                used = names + needed;
            }
        }
    }
    let part = |part: &Vec<usize>| {
        let cells = |row: &Vec<String>| part.iter().map(|&at| row.get(at).cloned().unwrap_or_default()).collect();
        whole(&rows.iter().map(cells).collect::<Vec<Vec<String>>>())
    };
    if parts.is_empty() { whole(&rows) } else { parts.iter().map(part).collect::<Vec<_>>().join("\n") }
}

/// The words of a cell in lines of at most so many columns; longer words are cut.
fn wrapped(cell: &str, columns: usize) -> String {
    let columns = columns.max(8);
    if cell.chars().count() <= columns {
        return cell.to_owned();
    }
    let mut lines = vec![String::new()];
    for word in cell.split_whitespace() {
        let letters: Vec<char> = word.chars().collect();
        for (number, piece) in letters.chunks(columns).enumerate() {
            let piece: String = piece.iter().collect();
            let line = lines.last_mut().expect("there is a first line");
            match line.chars().count() {
                0 => *line = piece,
                used if number == 0 && used + 1 + piece.chars().count() <= columns => *line += &format!(" {piece}"),
                _ => lines.push(piece),
            }
        }
    }
    lines.join("\n")
}

fn whole(rows: &[Vec<String>]) -> String {
    let mut builder = Builder::default();
    for row in rows {
        builder.push_record(row);
    }
    let mut table = builder.build();
    table.with(Style::psql()).modify(Columns::new(1..), Alignment::right());
    let text = table.to_string();
    text.lines().map(str::trim_end).collect::<Vec<_>>().join("\n") + "\n"
}

/// The words of a table's row.
pub fn row<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(str::to_owned).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows() -> Vec<Vec<String>> {
        vec![row(["name", "calls", "own"]), row(["sqrt", "7", "3"]), row(["triangle", "1,024", "12"])]
    }

    #[test]
    fn tables_stand_in_columns() {
        let expected = [
            " name     | calls | own",
            "----------+-------+-----",
            " sqrt     |     7 |   3",
            " triangle | 1,024 |  12",
            "",
        ];
        assert_eq!(whole(&rows()), expected.join("\n"));
        assert_eq!(narrow(&rows(), 24), expected.join("\n"));
    }

    #[test]
    fn tables_that_are_too_wide_go_on_below() {
        let expected = [
            " name     | calls",
            "----------+-------",
            " sqrt     |     7",
            " triangle | 1,024",
            "",
            " name     | own",
            "----------+-----",
            " sqrt     |   3",
            " triangle |  12",
            "",
        ];
        assert_eq!(narrow(&rows(), 22), expected.join("\n"));
        assert_eq!(narrow(&[], 80), "\n");
        let long = vec![row(["name", "what"]), row(["a", "one two three four five six"])];
        let text = narrow(&long, 24);
        assert!(text.lines().all(|line| line.chars().count() <= 24) && text.contains("four five six"), "{text}");
    }
}
