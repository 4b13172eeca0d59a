//! A study as a table: columns with names and kinds, one row a point; read from and written to CSV, JSON lines and Parquet. Equal tables are equal
//! octets.

use std::path::Path;

use messages::{Diagnostic, Report};
use serde_json::Value;

use super::row::{Cell, CellKind};
use crate::csv::quoted;
use crate::files;

/// Octets of the largest table.
const LARGEST: u64 = 4 << 30;

/// A table.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Dataset {
    /// Names and kinds of the columns.
    pub columns: Vec<(String, CellKind)>,
    /// Cells, row by row.
    pub rows: Vec<Vec<Cell>>,
}

/// A form of tables in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DatasetForm {
    /// Comma-separated values (RFC 4180), with a head; empty cells are empty.
    Csv,
    /// An object a line; empty cells are null.
    JsonLines,
    /// Parquet: optional columns of 64-bit numbers and texts, without compression.
    Parquet,
}

impl DatasetForm {
    /// The form that a file's name asks for.
    ///
    /// # Errors
    /// Another ending, and Parquet in a program that was built without it.
    pub fn of(path: &Path) -> Result<DatasetForm, String> {
        let ending = path.extension().map(|text| text.to_string_lossy().to_ascii_lowercase());
        match ending.as_deref() {
            Some("csv") => Ok(DatasetForm::Csv),
            Some("jsonl" | "ndjson") => Ok(DatasetForm::JsonLines),
            Some("parquet") if cfg!(feature = "full") => Ok(DatasetForm::Parquet),
            Some("parquet") => Err("this program was built without Parquet: `cargo build --features full` has it; .csv and .jsonl always work".into()),
            _ => Err(format!("`{}` ends in none of .csv, .jsonl and .parquet", path.display())),
        }
    }

    /// Lines of tables with these columns; `None` for a form without lines.
    pub fn lines(self, columns: &[String]) -> Option<TableLines> {
        let quoted = || columns.iter().map(|name| quoted(name)).collect::<Vec<_>>().join(",");
        let named = || columns.iter().map(|name| Value::from(name.as_str()).to_string()).collect();
        match self {
            DatasetForm::Csv => Some(TableLines::Csv(quoted())),
            DatasetForm::JsonLines => Some(TableLines::Json(named())),
            DatasetForm::Parquet => None,
        }
    }
}

impl Dataset {
    /// Number of a column.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|(known, _)| known == name)
    }

    /// The table in a form.
    ///
    /// # Errors
    /// None that a user could make.
    pub fn encode(&self, form: DatasetForm) -> Result<Vec<u8>, Report> {
        let names: Vec<String> = self.columns.iter().map(|(name, _)| name.clone()).collect();
        match form.lines(&names) {
            Some(lines) => {
                let text: Vec<String> =
                    lines.head().into_iter().chain(self.rows.iter().map(|row| lines.line(row))).collect();
                Ok(text.iter().flat_map(|line| [line.as_str(), "\n"]).collect::<String>().into_bytes())
            }
            #[cfg(feature = "full")]
            None => super::parquet::encode(self),
            #[cfg(not(feature = "full"))]
            None => Err(Diagnostic::error("this program was built without Parquet").into()),
        }
    }

    /// Reads a table by its name's ending.
    ///
    /// # Errors
    /// A file that cannot be read, or is no table.
    pub fn read(path: &Path) -> Result<Dataset, Report> {
        let form = DatasetForm::of(path).map_err(Diagnostic::error)?;
        Dataset::decode(form, files::read_up_to(LARGEST, path)?, &files::shown(path))
    }

    /// Reads the octets of a table; `name` stands in messages.
    ///
    /// # Errors
    /// Octets that are no table.
    pub fn decode(form: DatasetForm, octets: Vec<u8>, name: &str) -> Result<Dataset, Report> {
        match form {
            DatasetForm::Csv => Dataset::of_csv(&files::text(octets)).map_err(|why| refusal(name, &why)),
            DatasetForm::JsonLines => Dataset::of_json_lines(&files::text(octets)).map_err(|why| refusal(name, &why)),
            #[cfg(feature = "full")]
            DatasetForm::Parquet => super::parquet::decode(octets).map_err(|why| refusal(name, &why)),
            #[cfg(not(feature = "full"))]
            DatasetForm::Parquet => Err(Diagnostic::error("this program was built without Parquet").into()),
        }
    }

    fn of_csv(text: &str) -> Result<Dataset, String> {
        let mut lines = records(text)?.into_iter();
        let head = lines.next().ok_or("it is empty")?;
        let lines: Vec<Vec<String>> = lines.collect();
        if let Some((number, line)) = (2..).zip(&lines).find(|(_, line)| line.len() != head.len()) {
            return Err(format!("row {number} has {} cells, and the head has {}", line.len(), head.len()));
        }
        // A column holds numbers where all its cells are numbers; digits of hashes are texts.
        let kind = |column: usize| {
            let cells = || lines.iter().map(|line| line[column].as_str()).filter(|cell| !cell.is_empty());
            let is_whole = |cell: &str| cell.parse::<u64>().is_ok_and(|number| number.to_string() == cell);
            let is_real = |cell: &str| cell.parse::<f64>().is_ok_and(f64::is_finite) && cell.len() < 32;
            match () {
                () if cells().next().is_none() => CellKind::Text,
                () if cells().all(is_whole) => CellKind::Whole,
                () if cells().all(is_real) => CellKind::Real,
                () => CellKind::Text,
            }
        };
        let columns: Vec<(String, CellKind)> =
            head.iter().enumerate().map(|(number, name)| (name.clone(), kind(number))).collect();
        let cell = |(text, (_, kind)): (&String, &(String, CellKind))| match kind {
            _ if text.is_empty() => Cell::Empty,
            CellKind::Whole => text.parse().map_or(Cell::Empty, Cell::Whole),
            CellKind::Real => text.parse().map_or(Cell::Empty, Cell::Real),
            CellKind::Text => Cell::Text(text.clone()),
        };
        let rows = lines.iter().map(|line| line.iter().zip(&columns).map(cell).collect()).collect();
        Ok(Dataset { columns, rows })
    }

    fn of_json_lines(text: &str) -> Result<Dataset, String> {
        let mut dataset = Dataset::default();
        for (number, line) in (1..).zip(text.lines()) {
            let pairs = pairs(line).map_err(|error| format!("line {number}: {error}"))?;
            if number == 1 && pairs.is_empty() {
                return Err("line 1 has no keys".to_owned());
            }
            if number == 1 {
                dataset.columns = pairs.iter().map(|(name, _)| (name.clone(), CellKind::Text)).collect();
            }
            if !pairs.iter().map(|(name, _)| name).eq(dataset.columns.iter().map(|(name, _)| name)) {
                return Err(format!("line {number} has other keys than line 1"));
            }
            dataset.rows.push(pairs.into_iter().map(|(_, value)| cell(&value)).collect());
        }
        for (number, (_, kind)) in dataset.columns.iter_mut().enumerate() {
            *kind = kind_of(dataset.rows.iter().map(|row| &row[number]));
        }
        Ok(dataset)
    }
}

/// Lines of a table as text: each stands for itself, so that a table need not be in memory.
pub enum TableLines {
    /// Comma-separated values below this head.
    Csv(String),
    /// Objects with these names, which are JSON.
    Json(Vec<String>),
}

impl TableLines {
    /// The line above all rows, where there is one.
    pub fn head(&self) -> Option<String> {
        match self {
            TableLines::Csv(head) => Some(head.clone()),
            TableLines::Json(_) => None,
        }
    }

    /// The line of a row.
    pub fn line(&self, row: &[Cell]) -> String {
        match self {
            TableLines::Csv(_) => row.iter().map(plain).collect::<Vec<_>>().join(","),
            TableLines::Json(names) => {
                let pairs: Vec<String> =
                    names.iter().zip(row).map(|(name, cell)| format!("{name}:{}", json(cell))).collect();
                format!("{{{}}}", pairs.join(","))
            }
        }
    }
}

/// A cell of comma-separated values.
fn plain(cell: &Cell) -> String {
    match cell {
        Cell::Empty => String::new(),
        Cell::Whole(number) => number.to_string(),
        // With a point or an exponent, so that the column reads back as one of real numbers.
        Cell::Real(number) => format!("{number:?}"),
        Cell::Text(word) => quoted(word),
    }
}

fn json(cell: &Cell) -> Value {
    match cell {
        Cell::Empty => Value::Null,
        Cell::Whole(number) => (*number).into(),
        Cell::Real(number) => (*number).into(),
        Cell::Text(word) => word.as_str().into(),
    }
}

/// Kind of a column by its cells.
pub fn kind_of<'c>(cells: impl Iterator<Item = &'c Cell>) -> CellKind {
    let mut kind = None;
    for cell in cells {
        kind = match (cell, kind) {
            (Cell::Empty, kind) => kind,
            (Cell::Whole(_), None | Some(CellKind::Whole)) => Some(CellKind::Whole),
            (Cell::Whole(_) | Cell::Real(_), Some(CellKind::Real | CellKind::Whole) | None) => Some(CellKind::Real),
            _ => Some(CellKind::Text),
        };
    }
    kind.unwrap_or(CellKind::Text)
}

/// A JSON value as a cell; what is neither number nor text is its JSON.
pub fn cell(value: &Value) -> Cell {
    match value {
        Value::Null => Cell::Empty,
        Value::Number(number) => match number.as_u64() {
            Some(whole) => Cell::Whole(whole),
            None => Cell::Real(number.as_f64().unwrap_or_default()),
        },
        Value::String(text) => Cell::Text(text.clone()),
        other => Cell::Text(other.to_string()),
    }
}

fn refusal(name: &str, why: &str) -> Report {
    Diagnostic::error(format!("{name} is no table of a study: {why}")).into()
}

/// Records of comma-separated values.
fn records(text: &str) -> Result<Vec<Vec<String>>, String> {
    let (mut records, mut record, mut cell) = (Vec::new(), Vec::new(), String::new());
    let mut letters = text.chars().peekable();
    let mut is_quoted = false;
    while let Some(letter) = letters.next() {
        match letter {
            '"' if is_quoted && letters.peek() == Some(&'"') => {
                cell.push('"');
                letters.next();
            }
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => record.push(std::mem::take(&mut cell)),
            '\r' if !is_quoted && letters.peek() == Some(&'\n') => {}
            '\n' if !is_quoted => {
                record.push(std::mem::take(&mut cell));
                records.push(std::mem::take(&mut record));
            }
            letter => cell.push(letter),
        }
    }
    if is_quoted {
        return Err("a quotation has no end".to_owned());
    }
    if !cell.is_empty() || !record.is_empty() {
        record.push(cell);
        records.push(record);
    }
    Ok(records)
}

/// Keys and values of an object in their order.
fn pairs(line: &str) -> Result<Vec<(String, Value)>, serde_json::Error> {
    struct Pairs;
    impl<'de> serde::de::Visitor<'de> for Pairs {
        type Value = Vec<(String, Value)>;

        fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
            f.write_str("an object")
        }

        fn visit_map<A: serde::de::MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
            let mut pairs = Vec::new();
            while let Some(pair) = map.next_entry()? {
                pairs.push(pair);
            }
            Ok(pairs)
        }
    }
    use serde::Deserializer;
    serde_json::Deserializer::from_str(line).deserialize_map(Pairs)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A table with cells of each kind, and texts that are hard to write.
    pub fn sample() -> Dataset {
        let text = |text: &str| Cell::Text(text.to_owned());
        Dataset {
            columns: vec![
                ("name".into(), CellKind::Text),
                ("clocks".into(), CellKind::Whole),
                ("rmse".into(), CellKind::Real),
                ("refused".into(), CellKind::Text),
            ],
            rows: vec![
                vec![text("a,\"b\"\nc"), Cell::Whole(u64::MAX >> 1), Cell::Real(0.1 + 0.2), Cell::Empty],
                vec![text("é"), Cell::Empty, Cell::Empty, text("it does not fit")],
                vec![text("plain"), Cell::Whole(0), Cell::Real(1e-300), Cell::Empty],
            ],
        }
    }

    #[test]
    fn tables_read_back_as_themselves() {
        let table = sample();
        for form in [DatasetForm::Csv, DatasetForm::JsonLines] {
            assert_eq!(Dataset::decode(form, table.encode(form).unwrap(), "a"), Ok(table.clone()));
        }
    }

    #[test]
    fn what_is_no_table_is_refused() {
        for text in ["", "a,b\n1\n", "a\n\"1\n"] {
            assert!(Dataset::of_csv(text).is_err(), "{text:?}");
        }
        assert_eq!(Dataset::of_json_lines("{}\n{}\n"), Err("line 1 has no keys".to_owned()));
        for text in ["{\"a\":1}\n{\"b\":1}\n", "[1]\n", "{\"a\":"] {
            assert!(Dataset::of_json_lines(text).is_err(), "{text:?}");
        }
    }
}
