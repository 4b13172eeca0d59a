//! Tables as Parquet, without compression and in one group of rows: columns are optional, of 64-bit whole numbers, doubles or texts.

use std::sync::Arc;

use messages::{Diagnostic, Report};
use parquet::basic::{LogicalType, Repetition, Type};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::record::Field;
use parquet::schema::types::Type as SchemaType;

use super::dataset::{Dataset, kind_of};
use super::row::{Cell, CellKind};

/// The table as the octets of a file.
///
/// # Errors
/// None that a user could make.
pub fn encode(table: &Dataset) -> Result<Vec<u8>, Report> {
    written(table).map_err(|error| Diagnostic::error(format!("the table cannot be written as Parquet: {error}")).into())
}

fn written(table: &Dataset) -> Result<Vec<u8>, ParquetError> {
    let fields = table.columns.iter().map(|(name, kind)| {
        let (physical, logical) = match kind {
            CellKind::Whole => (Type::INT64, None),
            CellKind::Real => (Type::DOUBLE, None),
            CellKind::Text => (Type::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let field = SchemaType::primitive_type_builder(name, physical).with_repetition(Repetition::OPTIONAL);
        field.with_logical_type(logical).build().map(Arc::new)
    });
    let fields = fields.collect::<Result<Vec<_>, _>>()?;
    let schema = Arc::new(SchemaType::group_type_builder("study").with_fields(fields).build()?);
    // The name of the writer would change with its version, and the octets with it.
    let properties = WriterProperties::builder().set_created_by("lancer".to_owned()).build();
    let mut writer = SerializedFileWriter::new(Vec::new(), schema, Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    for (number, (_, kind)) in table.columns.iter().enumerate() {
        column(&mut group, table, number, *kind)?;
    }
    group.close()?;
    writer.into_inner()
}

/// Writes the next column: a definition level a row, and the values that there are.
fn column(
    group: &mut SerializedRowGroupWriter<'_, Vec<u8>>,
    table: &Dataset,
    number: usize,
    kind: CellKind,
) -> Result<(), ParquetError> {
    let cells = || table.rows.iter().map(|row| &row[number]);
    // The cells 5, empty and 7 have the levels 1 0 1 and the values 5 7.
    let levels: Vec<i16> = cells().map(|cell| i16::from(*cell != Cell::Empty)).collect();
    let Some(mut writer) = group.next_column()? else { return Ok(()) };
    // The kind is one that all cells fit: whole numbers may stand among reals, and both among texts.
    match kind {
        CellKind::Whole => {
            let values: Vec<i64> = cells()
                .filter_map(|cell| if let Cell::Whole(number) = cell { Some(*number as i64) } else { None })
                .collect();
            writer.typed::<Int64Type>().write_batch(&values, Some(&levels), None)?;
        }
        CellKind::Real => {
            let real = |cell: &Cell| match cell {
                Cell::Real(number) => Some(*number),
                Cell::Whole(number) => Some(*number as f64),
                _ => None,
            };
            let values: Vec<f64> = cells().filter_map(real).collect();
            writer.typed::<DoubleType>().write_batch(&values, Some(&levels), None)?;
        }
        CellKind::Text => {
            let text = |cell: &Cell| match cell {
                Cell::Text(text) => Some(ByteArray::from(text.as_str())),
                Cell::Whole(number) => Some(ByteArray::from(number.to_string().as_str())),
                Cell::Real(number) => Some(ByteArray::from(number.to_string().as_str())),
                Cell::Empty => None,
            };
            let values: Vec<ByteArray> = cells().filter_map(text).collect();
            writer.typed::<ByteArrayType>().write_batch(&values, Some(&levels), None)?;
        }
    }
    writer.close()
}

/// The table of a file's octets.
///
/// # Errors
/// Octets that are no Parquet, or hold lists and tables in tables.
pub fn decode(octets: Vec<u8>) -> Result<Dataset, String> {
    let reader = SerializedFileReader::new(bytes::Bytes::from(octets)).map_err(|error| error.to_string())?;
    let mut table = Dataset::default();
    for column in reader.metadata().file_metadata().schema_descr().columns() {
        table.columns.push((column.name().to_owned(), CellKind::Text));
    }
    for row in reader.get_row_iter(None).map_err(|error| error.to_string())? {
        let row = row.map_err(|error| error.to_string())?;
        let cells = row
            .get_column_iter()
            .map(|(name, field)| cell(field).ok_or_else(|| format!("`{name}` holds no plain value")));
        table.rows.push(cells.collect::<Result<_, _>>()?);
    }
    for (number, (_, kind)) in table.columns.iter_mut().enumerate() {
        *kind = kind_of(table.rows.iter().map(|row| &row[number]));
    }
    Ok(table)
}

fn cell(field: &Field) -> Option<Cell> {
    Some(match field {
        Field::Null => Cell::Empty,
        Field::Str(text) => Cell::Text(text.clone()),
        Field::Double(number) => Cell::Real(*number),
        Field::Float(number) => Cell::Real(f64::from(*number)),
        Field::Long(number) => u64::try_from(*number).map_or(Cell::Real(*number as f64), Cell::Whole),
        Field::Int(number) => u64::try_from(*number).map_or(Cell::Real(f64::from(*number)), Cell::Whole),
        Field::ULong(number) => Cell::Whole(*number),
        Field::Bool(is_true) => Cell::Text(is_true.to_string()),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::super::dataset::tests::sample;
    use super::*;

    #[test]
    fn tables_read_back_as_themselves() {
        let octets = encode(&sample()).unwrap();
        assert!(octets.starts_with(b"PAR1") && octets.ends_with(b"PAR1"));
        assert_eq!(encode(&sample()).unwrap(), octets);
        assert_eq!(decode(octets).unwrap(), sample());
        assert!(decode(b"PAR1".to_vec()).is_err());
    }
}
