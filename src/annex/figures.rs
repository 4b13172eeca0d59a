//! Figures that the report derives from its rows (6.1, 6.2, Annex I), derived from ours.

use emu::machine::Config;
use emu::quantity::Octets;
use isa::{Class, Program};
use kernels::annex::{Figure, figures};
use scenes::layout::Layout;

use super::Measurement;

/// Cores of the report's machine, and pixels of its frame.
const CORES: f64 = 4.0;
const FRAME: f64 = 640.0 * 480.0;

/// A figure with its counted value.
#[derive(Clone, Debug)]
pub struct Derived {
    /// The figure.
    pub figure: &'static Figure,
    /// Value from the pixel of 22 nodes.
    pub counted: f64,
}

/// Operations of a pixel and clocks of its accesses to memory.
#[derive(Clone, Copy, Debug)]
pub struct Pixel {
    /// Elementary operations, a clock each.
    pub operations: f64,
    /// Clocks of the bus.
    pub memory: f64,
}

impl Pixel {
    /// Of operations and octets, on the report's bus.
    pub fn new(operations: f64, octets: u64) -> Pixel {
        Pixel { operations, memory: Config::default().bus.length(Octets(octets), 0).0 as f64 }
    }

    /// The pixel that the row of 22 nodes measures.
    pub fn of(measured: &[Measurement]) -> Option<(Pixel, &Program)> {
        let pixel = measured.iter().find(|measurement| measurement.row.id == "rt.pixel")?;
        Some((Pixel::new(pixel.most.elementary() as f64, pixel.most[Class::Octet]), &pixel.program))
    }

    /// Microseconds of a pixel with four cores: as 6.1 has it, or what the bus takes where that is more.
    pub fn microseconds(&self) -> f64 {
        // With four cores the bus is busy for the memory of four pixels while each computes one: whichever takes longer.
        let clocks = ((self.operations + self.memory) / CORES).max(self.memory);
        clocks / Config::default().clock_hz as f64 * 1e6
    }
}

/// All figures; none when there is no pixel.
pub fn derive(measured: &[Measurement]) -> Vec<Derived> {
    let Some((pixel, program)) = Pixel::of(measured) else { return Vec::new() };
    let derived = figures().iter().map(|figure| {
        let counted = counted(&figure.id, pixel, program);
        counted.map(|counted| Derived { figure, counted })
    });
    derived.flatten().collect()
}

fn counted(id: &str, pixel: Pixel, program: &Program) -> Option<f64> {
    let Pixel { operations, memory } = pixel;
    let symbol = |name: &str| program.symbols.get(name).map(|&value| value as f64);
    let layout = Layout::Report.fixed_structures();
    Some(match id {
        "pixel_operations" => operations,
        "memory_clocks" => memory,
        "processors" => operations / memory,
        "saturation" => (operations + memory) / memory,
        "bus_busy" => 100.0 * (CORES * memory / (operations + memory)).min(1.0),
        "pixel_time" => pixel.microseconds() / 1e3,
        "pixel_rate" => 1e3 / pixel.microseconds(),
        "frame_time" => FRAME * pixel.microseconds() / 1e6,
        "buffer.kd_nodes" => f64::from(2 * layout.node.octets()),
        // Registers hold both.
        "buffer.addresses" => 0.0,
        // One is tested at a time.
        "buffer.triangles" | "buffer.nearest_triangle" | "storage.triangle" => f64::from(layout.triangle.octets()),
        // Two a level below the camera ray's.
        "buffer.ray_tree" => (2.0 * symbol("BOUNCES")? + 1.0) * (symbol("treenode.near_t")? + 4.0),
        "buffer.materials_and_lights" => f64::from(layout.material.octets() + layout.light.octets()),
        // The driver's own data begin there.
        "buffer.total" => symbol("START")?,
        "storage.node" => f64::from(layout.node.octets()),
        "storage.reference" => f64::from(layout.reference.octets()),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_figure_is_derived() {
        let measured = crate::annex::measure().unwrap();
        assert_eq!(derive(&measured).len(), figures().len());
    }

    #[test]
    fn the_printed_figures_follow_from_each_other() {
        // 203,000 operations and 49,600 clocks of memory: 4.09, 5.09, 78.5 %, 0.6315 ms, 1.583 kHz, 194 s.
        let pixel = Pixel::new(203_000.0, 24_800);
        let program = Program::default();
        let value = |id: &str| counted(id, pixel, &program).unwrap();
        for (id, printed) in
            [("memory_clocks", 49_600.0), ("processors", 4.09), ("saturation", 5.09), ("bus_busy", 78.5)]
        {
            assert!((value(id) / printed - 1.0).abs() < 1e-3, "{id}: {}", value(id));
        }
        for (id, printed) in [("pixel_time", 0.6315), ("pixel_rate", 1.583), ("frame_time", 194.0)] {
            assert!((value(id) / printed - 1.0).abs() < 1e-3, "{id}: {}", value(id));
        }
    }
}
