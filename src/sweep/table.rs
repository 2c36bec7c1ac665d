//! Results as tables: CSV for people, Parquet for programs; rows in the order of the points.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::{Type, TypePtr};
use toml::Value;

use super::axis::Column as Kind;
use super::journal::Record;
use super::measures::COLUMNS;
use super::plan::Plan;
use crate::error::Fault;

/// A column of the table.
#[derive(Clone, Debug, PartialEq)]
struct Column {
    name: String,
    cells: Cells,
}

/// Its cells; of measures and reasons some may be empty.
#[derive(Clone, Debug, PartialEq)]
enum Cells {
    Real(Vec<Option<f64>>),
    Integer(Vec<i64>),
    Boolean(Vec<bool>),
    Text(Vec<Option<String>>),
}

/// Columns: the point, what was varied, how it went, the measures, why there are none.
fn columns(plan: &Plan, records: &[Record]) -> Vec<Column> {
    let rows = records;
    let mut columns = vec![Column {
        name: "point".to_string(),
        cells: Cells::Integer(rows.iter().map(|r| r.point as i64).collect()),
    }];
    for (at, axis) in plan.axes.iter().enumerate() {
        let values = rows.iter().map(|r| &plan.points[r.point][at]);
        let cells = match axis.column {
            Kind::Real(_) => Cells::Real(values.map(Value::as_float).collect()),
            Kind::Integer => {
                Cells::Integer(values.map(|v| v.as_integer().unwrap_or_default()).collect())
            }
            Kind::Boolean => {
                Cells::Boolean(values.map(|v| v.as_bool().unwrap_or_default()).collect())
            }
            Kind::Text => Cells::Text(values.map(|v| v.as_str().map(str::to_string)).collect()),
        };
        columns.push(Column { name: axis.name.clone(), cells });
    }
    let status = rows.iter().map(|r| Some(if r.outcome.is_ok() { "ok" } else { "failed" }.into()));
    columns.push(Column { name: "status".to_string(), cells: Cells::Text(status.collect()) });
    for (at, name) in COLUMNS.iter().enumerate() {
        let cells = rows.iter().map(|r| r.outcome.as_ref().ok().map(|measures| measures[at]));
        let cells = Cells::Real(cells.map(|x| x.filter(|x| x.is_finite())).collect());
        columns.push(Column { name: (*name).to_string(), cells });
    }
    let reasons = rows.iter().map(|r| r.outcome.as_ref().err().cloned());
    columns.push(Column { name: "reason".to_string(), cells: Cells::Text(reasons.collect()) });
    columns
}

/// The table as CSV; an empty cell is a measure that there is not.
///
/// # Errors
/// [`Fault::File`].
pub fn csv(plan: &Plan, records: &[Record]) -> Result<Vec<u8>, Fault> {
    let columns = columns(plan, records);
    let mut writer = csv::Writer::from_writer(Vec::new());
    let failed = |e: csv::Error| Fault::unusable("sweep.csv", e);
    let header = columns.iter().map(|c| c.name.as_str());
    writer.write_record(header).map_err(failed)?;
    for row in 0..records.len() {
        let cells = columns.iter().map(|c| c.cells.text(row));
        writer.write_record(cells).map_err(failed)?;
    }
    writer.into_inner().map_err(|e| Fault::unusable("sweep.csv", e))
}

/// Points of the plan as CSV: number and values.
///
/// # Errors
/// [`Fault::File`].
pub fn points_csv(plan: &Plan) -> Result<Vec<u8>, Fault> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let failed = |e: csv::Error| Fault::unusable("points", e);
    let names = plan.axes.iter().map(|axis| axis.name.as_str());
    let header: Vec<&str> = std::iter::once("point").chain(names).collect();
    writer.write_record(header).map_err(failed)?;
    for (index, values) in plan.points.iter().enumerate() {
        let cells = values.iter().map(|value| match value {
            Value::String(text) => text.clone(),
            other => other.to_string(),
        });
        let row: Vec<String> = std::iter::once(index.to_string()).chain(cells).collect();
        writer.write_record(row).map_err(failed)?;
    }
    writer.into_inner().map_err(|e| Fault::unusable("points", e))
}

impl Cells {
    fn text(&self, row: usize) -> String {
        match self {
            Self::Real(cells) => cells[row].map_or(String::new(), |x| format!("{x:?}")),
            Self::Integer(cells) => cells[row].to_string(),
            Self::Boolean(cells) => cells[row].to_string(),
            Self::Text(cells) => cells[row].clone().unwrap_or_default(),
        }
    }

    fn schema(&self, name: &str) -> Result<TypePtr, ParquetError> {
        let (physical, logical, repetition) = match self {
            Self::Real(_) => (Physical::DOUBLE, None, Repetition::OPTIONAL),
            Self::Integer(_) => (Physical::INT64, None, Repetition::REQUIRED),
            Self::Boolean(_) => (Physical::BOOLEAN, None, Repetition::REQUIRED),
            Self::Text(_) => {
                (Physical::BYTE_ARRAY, Some(LogicalType::String), Repetition::OPTIONAL)
            }
        };
        let builder = Type::primitive_type_builder(name, physical);
        builder.with_logical_type(logical).with_repetition(repetition).build().map(Arc::new)
    }

    fn write(&self, column: &mut SerializedColumnWriter<'_>) -> Result<(), ParquetError> {
        match self {
            Self::Real(cells) => {
                let values: Vec<f64> = cells.iter().copied().flatten().collect();
                column.typed::<DoubleType>().write_batch(&values, Some(&there(cells)), None)?;
            }
            Self::Integer(cells) => {
                column.typed::<Int64Type>().write_batch(cells, None, None)?;
            }
            Self::Boolean(cells) => {
                column.typed::<BoolType>().write_batch(cells, None, None)?;
            }
            Self::Text(cells) => {
                let values: Vec<ByteArray> =
                    cells.iter().flatten().map(|text| text.as_bytes().to_vec().into()).collect();
                column.typed::<ByteArrayType>().write_batch(&values, Some(&there(cells)), None)?;
            }
        }
        Ok(())
    }
}

/// Definition levels: 1 where there is a value.
fn there<T>(cells: &[Option<T>]) -> Vec<i16> {
    cells.iter().map(|cell| i16::from(cell.is_some())).collect()
}

/// Writes the table as a Parquet file, with units and the plan's fingerprint in its metadata.
///
/// # Errors
/// [`Fault::File`].
pub fn parquet(plan: &Plan, records: &[Record], path: &Path) -> Result<(), Fault> {
    let columns = columns(plan, records);
    write_parquet(plan, &columns, path).map_err(|e| Fault::unusable(path, e))
}

fn write_parquet(plan: &Plan, columns: &[Column], path: &Path) -> Result<(), ParquetError> {
    let fields: Result<Vec<TypePtr>, _> = columns.iter().map(|c| c.cells.schema(&c.name)).collect();
    let schema = Type::group_type_builder("sweep").with_fields(fields?).build()?;
    let units = plan.axes.iter().filter_map(|axis| match axis.column {
        Kind::Real(unit) => Some(KeyValue::new(format!("unit:{}", axis.name), unit.to_string())),
        _ => None,
    });
    let mut notes: Vec<KeyValue> = units.collect();
    notes.push(KeyValue::new("sweep".to_string(), plan.fingerprint()));
    notes.push(KeyValue::new("version".to_string(), env!("CARGO_PKG_VERSION").to_string()));
    let properties = WriterProperties::builder()
        .set_created_by(concat!("tread ", env!("CARGO_PKG_VERSION")).to_string())
        .set_key_value_metadata(Some(notes))
        .build();
    let file = File::create(path)?;
    let mut writer = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    for column in columns {
        if let Some(mut place) = group.next_column()? {
            column.cells.write(&mut place)?;
            place.close()?;
        }
    }
    group.close()?;
    writer.close()?;
    Ok(())
}

/// Writes both tables and says where they are. Each appears whole or not at all.
///
/// # Errors
/// [`Fault::File`].
pub fn write(plan: &Plan, records: &[Record], folder: &Path) -> Result<[PathBuf; 2], Fault> {
    let [csv_path, parquet_path] = ["sweep.csv", "sweep.parquet"].map(|name| folder.join(name));
    let part = |path: &Path| path.with_extension("part");
    let text = csv(plan, records)?;
    std::fs::write(part(&csv_path), text).map_err(|e| Fault::file(&csv_path, &e))?;
    std::fs::rename(part(&csv_path), &csv_path).map_err(|e| Fault::file(&csv_path, &e))?;
    parquet(plan, records, &part(&parquet_path))?;
    std::fs::rename(part(&parquet_path), &parquet_path)
        .map_err(|e| Fault::file(&parquet_path, &e))?;
    Ok([csv_path, parquet_path])
}
