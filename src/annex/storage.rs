//! Annex I's structures in memory beside those of the layouts here, field by field, and a scene of as many triangles as the report assumes.

use kernels::KernelSet;
use kernels::annex::{PrintedStructure, structures};
use messages::Report;
use scenes::generate::{self, GenerateOptions};
use scenes::image::{self, MemoryImage, MemoryOptions};
use scenes::layout::{Layout, Structure, StructureSet};
use scenes::model::View;
use schemars::JsonSchema;
use serde::Serialize;

/// The scene that has as many triangles as Annex I: 60,000.
const SCENE: &str = "terrain";

/// Octets of a megabyte, as Annex I divides.
const MEGABYTE: f64 = 1_048_576.0;

/// Annex I's storage.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Storage {
    /// The scene whose triangles, nodes and references are counted.
    pub scene: &'static str,
    /// The rows, structure by structure.
    pub rows: Vec<StorageRow>,
}

/// A row of Annex I's table of structures.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct StorageRow {
    /// Name of the structure.
    pub structure: &'static str,
    /// Label of the structure as printed.
    pub label: &'static str,
    /// Element as printed; `count` for how many such structures there are.
    pub element: &'static str,
    /// As printed, or what the printed total implies.
    pub printed: f64,
    /// In the layout `report`, on the scene with the report's tree.
    pub counted: f64,
    /// In the layout `wide`, on the scene with the tree of the profile `ray`; null for a field that the layout does without.
    pub wide: Option<f64>,
    /// `bits`, `octets`, `MB` of 2^20 octets, or empty for a number.
    pub unit: &'static str,
}

impl Storage {
    /// The rows, with the scene put into memory in both layouts.
    ///
    /// # Errors
    /// None that a generated scene has.
    pub fn measure() -> Result<Storage, Report> {
        let scene = generate::scene(SCENE, &GenerateOptions::default())?;
        let memory = |kernels: KernelSet, layout: Layout| {
            let (kd_depth, kd_method) = (kernels.kd_depth(), kernels.kd_method());
            let options = MemoryOptions { layout, kd_depth, kd_method, ..MemoryOptions::default() };
            image::build(&scene, &View::new(scene.size), &options)
        };
        let (report, wide) = (memory(KernelSet::Report, Layout::Report)?, memory(KernelSet::Ray, Layout::Wide)?);
        Ok(Storage {
            scene: SCENE,
            rows: structures().iter().flat_map(|printed| rows(printed, &report, &wide)).collect(),
        })
    }
}

/// A structure by its name, and the number of them in an image.
fn in_image<'i>(name: &str, set: &'i StructureSet, image: &MemoryImage) -> (&'i Structure, f64) {
    let structure =
        set.all().into_iter().find(|structure| structure.name == name).expect("layouts have the structures of Annex I");
    let count = match name {
        "node" => image.tree.nodes as f64,
        "reference" => image.tree.references as f64,
        _ => f64::from(image.counts.triangles),
    };
    (structure, count)
}

/// Bits of the whole structure, gaps included.
fn bits(structure: &Structure) -> f64 {
    f64::from(8 * structure.octets())
}

fn rows(printed: &'static PrintedStructure, report: &MemoryImage, wide: &MemoryImage) -> Vec<StorageRow> {
    // Find the structure in both layouts, with the number of them in the scene
    let (own, others) = (Layout::Report.fixed_structures(), Layout::Wide.fixed_structures());
    let (own, count) = in_image(&printed.structure, &own, report);
    let (other, other_count) = in_image(&printed.structure, &others, wide);
    let field = |structure: &Structure, name: &str| {
        let found = structure.fields.iter().find(|field| field.name == name);
        found.map(|field| f64::from(field.elements * field.bits))
    };
    let row =
        |element: &'static str, printed_number: f64, counted: f64, wide: Option<f64>, unit: &'static str| StorageRow {
            structure: &printed.structure,
            label: &printed.label,
            element,
            printed: printed_number,
            counted,
            wide,
            unit,
        };
    // Compare field by field; one that `wide` does without stays empty there
    let fields = printed.fields.iter().map(|(element, bits, name, wide_name)| {
        let counted = field(own, name).expect("annex.toml names a field of the layout");
        row(element, f64::from(*bits), counted, field(other, wide_name), "bits")
    });
    let octets = |structure: &Structure| f64::from(structure.octets());
    let megabytes = |structure: &Structure, count: f64| octets(structure) * count / MEGABYTE;
    // Compare whole structures: 60,000 triangles of 31 octets are 1,860,000 / 2^20 = 1.77 MB
    let totals = [
        row("total", f64::from(printed.bits), bits(own), Some(bits(other)), "bits"),
        row("total", f64::from(printed.octets), octets(own), Some(octets(other)), "octets"),
        row("count", printed.count as f64, count, Some(other_count), ""),
        row("all", printed.megabytes, megabytes(own, count), Some(megabytes(other, other_count)), "MB"),
    ];
    fields.chain(totals).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Printed cells follow from each other: bits from fields, octets from bits, megabytes from octets and number.
    #[test]
    fn printed_cells_add_up() {
        for printed in structures() {
            assert_eq!(printed.fields.iter().map(|(_, bits, ..)| bits).sum::<u32>(), printed.bits, "{}", printed.label);
            assert_eq!(printed.octets * 8, printed.bits, "{}", printed.label);
            let megabytes = f64::from(printed.octets) * printed.count as f64 / MEGABYTE;
            assert!((megabytes - printed.megabytes).abs() < 1e-6, "{}: {megabytes}", printed.label);
        }
    }

    #[test]
    fn the_reports_layout_has_the_printed_bits() {
        let storage = Storage::measure().unwrap();
        for row in &storage.rows {
            if row.unit == "bits" || row.unit == "octets" || row.structure == "triangle" {
                assert!((row.counted - row.printed).abs() < 1e-6, "{row:?}");
            }
        }
        let number = |structure: &str, element: &str, unit: &str| {
            let is_it = |row: &&StorageRow| row.structure == structure && row.element == element && row.unit == unit;
            storage.rows.iter().find(is_it).unwrap().clone()
        };
        let triangles = number("triangle", "all", "MB");
        assert!((triangles.counted - 1.773834).abs() < 1e-6, "{triangles:?}");
        // 38 octets of a triangle for 31: coordinates of 32 bits, materials of 16, no box.
        assert_eq!(number("triangle", "total", "octets").wide, Some(38.0));
        assert_eq!(number("triangle", "small", "bits").wide, None);
    }
}
