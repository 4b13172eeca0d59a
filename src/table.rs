//! Tables as people read them, within 100 columns.

use tabled::builder::Builder;
use tabled::settings::object::Columns;
use tabled::settings::{Alignment, Style};

/// A table: the first row is its head, the first column its names; all other columns stand to the right.
pub fn table<R: IntoIterator<Item = String>>(rows: impl IntoIterator<Item = R>) -> String {
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

    #[test]
    fn tables_stand_in_columns() {
        let text = table([row(["name", "calls"]), row(["sqrt", "7"]), row(["triangle", "1,024"])]);
        let expected = [" name     | calls", "----------+-------", " sqrt     |     7", " triangle | 1,024", ""];
        assert_eq!(text, expected.join("\n"));
    }
}
