//! The results of a picture as tables for people. Exact numbers of everything are in the JSON.

use fixed::types::I32F32;
use isa::Class;
use scenes::metrics::PictureError;

use crate::drawing::Drawing;
use crate::numeral::{count, grouped, percent, short};
use crate::protection::{self, ProtectionUse};
use crate::result::{ByClass, ByKind, OperationTimes, ProcessorResult, RegionCounts, Render};
use crate::table::{row, table};

/// Classes with a column of their own in tables of functions.
const COLUMNS: [Class; 7] = [Class::Add, Class::Sub, Class::Mul, Class::Div, Class::Cmp, Class::Mem, Class::Octet];

/// One line on what was drawn.
pub fn title(result: &Render) -> String {
    let part = match result.crop {
        Some([column, row, ..]) => format!(" from {column},{row} on"),
        None => String::new(),
    };
    format!(
        "{}: {}, {} x {} pixels{part}, kernels `{}` on machine `{}`\n",
        result.scene,
        count(result.triangles as u64, "triangle", "triangles"),
        result.width,
        result.height,
        result.profile,
        result.machine,
    )
}

/// One line on the rays.
pub fn rays(result: &Render) -> String {
    let rays = &result.rays;
    format!(
        "rays: {} camera, {} reflected, {} refracted, {} shadow\n",
        grouped(rays.camera),
        grouped(rays.reflected),
        grouped(rays.refracted),
        grouped(rays.shadow)
    )
}

/// Functions that the ten lines name.
const FUNCTIONS_NAMED: usize = 4;

/// The picture in ten lines of at most 80 columns: rays, operations, time, waits, bus, error, hashes.
pub fn brief(result: &Render) -> String {
    let (counts, main) = (&result.counts.0, &result.main.counts.0);
    let pixels = u64::from(result.width) * u64::from(result.height);
    let operations = format!(
        "operations: {} of the cores, {} a pixel; {} of the main processor\n",
        grouped(counts.elementary()),
        grouped((counts.elementary() as f64 / pixels.max(1) as f64).round() as u64),
        grouped(main.elementary()),
    );
    // Own operations say where the work is done; those of a caller would say so again.
    let mut functions: Vec<&RegionCounts> = result.functions.iter().chain(&result.regions).collect();
    functions.sort_by_key(|function| std::cmp::Reverse(function.exclusive.counts.0.elementary()));
    let own = |function: &&RegionCounts| {
        let share = percent(function.exclusive.counts.0.elementary(), counts.elementary());
        format!("{} {share}", function.name)
    };
    let functions: Vec<String> = functions.iter().take(FUNCTIONS_NAMED).map(own).collect();
    let sum = |part: fn(&ProcessorResult) -> u64| {
        percent(result.cores.iter().map(part).sum(), result.clocks * result.cores.len() as u64)
    };
    let time = format!(
        "time: {} a pixel, {} in all, {} clocks at {} MHz\n",
        seconds(result.pixel_seconds),
        seconds(result.seconds),
        grouped(result.clocks),
        result.clock_hz as f64 / 1e6,
    );
    let cores = format!(
        "{}: busy {}, waiting for the bus {}, idle {}\n",
        count(result.cores.len() as u64, "core", "cores"),
        sum(|core| core.busy),
        sum(|core| core.waiting),
        sum(|core| core.idle),
    );
    let bus = format!(
        "bus: busy {}, {} octets, longest wait {} clocks\n",
        percent(result.bus.busy, result.clocks),
        grouped(result.bus.moved),
        grouped(result.bus.longest_wait),
    );
    let error = match &result.error {
        None => "difference from double precision: not measured\n".to_owned(),
        Some(error) => format!(
            "difference from double precision: PSNR {}, {} off by 1/255\n",
            error.psnr_db.map_or("none (equal)".to_owned(), |psnr| format!("{psnr:.2} dB")),
            count(error.off_pixels, "pixel", "pixels"),
        ),
    };
    let most = format!("most in: {}\n", functions.join(", "));
    let engine = engine(result.engine, result.engine_because);
    title(result) + &rays(result) + &operations + &most + &time + &engine + &cores + &bus + &error + &hashes(result)
}

/// The engine that ran, and why a faster one that was wanted did not; nothing where that ran.
pub fn engine(name: &str, because: Option<&str>) -> String {
    because.map_or(String::new(), |why| format!("engine: {name} ({why})\n"))
}

/// Calls, inclusive operations and the classes of own ones, function by function: first those of the cores, then
/// those of the main processor.
pub fn functions(result: &Render) -> String {
    let cores = function_table(&[(&result.functions, ""), (&result.regions, "  ")]);
    let main = function_table(&[(&result.main.functions, "")]);
    format!(
        "Operations by function: inclusive and own ones (add, sub, mul, div and cmp), own ones by class\n{cores}\nMain processor\n{main}"
    )
}

/// Lists of functions, each under a prefix, those with the most inclusive operations first.
pub fn function_table(lists: &[(&[RegionCounts], &str)]) -> String {
    let head = ["function", "calls", "incl.", "own"].into_iter().map(str::to_owned);
    let mut rows: Vec<Vec<String>> = vec![head.chain(COLUMNS.iter().map(|class| class.name().to_owned())).collect()];
    for (regions, prefix) in lists {
        let mut regions: Vec<&RegionCounts> = regions.iter().filter(|region| region.calls != 0).collect();
        regions.sort_by_key(|region| std::cmp::Reverse(region.inclusive.counts.0.elementary()));
        rows.extend(regions.into_iter().map(|region| function(region, prefix)));
    }
    table(rows)
}

fn function(region: &RegionCounts, prefix: &str) -> Vec<String> {
    let own = &region.exclusive.counts.0;
    let totals = [region.calls, region.inclusive.counts.0.elementary(), own.elementary()];
    let classes = COLUMNS.iter().map(|&class| own[class]);
    std::iter::once(format!("{prefix}{}", region.name)).chain(totals.into_iter().chain(classes).map(short)).collect()
}

/// All operations by class.
pub fn classes(result: &Render) -> String {
    let (counts, main) = (&result.counts.0, &result.main.counts.0);
    let pixels = u64::from(result.width) * u64::from(result.height);
    let mut rows = vec![row(["class", "cores", "a pixel", "main", "what"])];
    let a_pixel = |count: u64| format!("{:.1}", count as f64 / pixels.max(1) as f64);
    for (class, count) in counts.iter() {
        let first = class.doc().trim().split(['.', ';', ':', '(']).next().unwrap_or_default().trim().to_lowercase();
        rows.push(vec![class.name().into(), grouped(count), a_pixel(count), grouped(main[class]), first]);
    }
    let (all, all_main) = (counts.elementary(), main.elementary());
    let what = "add, sub, mul, div and cmp together".to_owned();
    rows.push(vec!["elementary".into(), grouped(all), a_pixel(all), grouped(all_main), what]);
    format!("Operations by class\n{}", left_last(rows))
}

/// A table whose last column is prose.
fn left_last(rows: Vec<Vec<String>>) -> String {
    let width = rows.iter().filter_map(|row| row.last()).map(String::len).max().unwrap_or(0);
    let pad = |mut row: Vec<String>| {
        if let Some(last) = row.last_mut() {
            *last = format!("{last:<width$}");
        }
        row
    };
    let text = table(rows.into_iter().map(pad));
    text.lines().map(str::trim_end).collect::<Vec<_>>().join("\n") + "\n"
}

/// Clocks of all processors, and of the bus.
pub fn processors(result: &Render) -> String {
    // Shares of the frame, processor by processor; the main processor has no pixels of its own.
    let mut rows = vec![row(["processor", "busy", "waiting for the bus", "idle", "octets", "pixels"])];
    let processor = |name: String, of: &ProcessorResult| {
        let share = |part: u64| percent(part, result.clocks);
        vec![name, share(of.busy), share(of.waiting), share(of.idle), grouped(of.octets), grouped(of.items)]
    };
    rows.extend(result.cores.iter().enumerate().map(|(number, core)| processor(format!("core {number}"), core)));
    let mut main = processor("main".into(), &result.main.clocks);
    main[5] = String::new();
    rows.push(main);
    // The frame as a whole, with the bus below the table.
    let bus = &result.bus;
    let mut text = format!(
        "Machine: {} clocks, {} at {} MHz, {} a pixel; {} by the engine `{}`{}\n{}bus: busy {}, {} octets in {} transfers, longest wait {} clocks\n",
        grouped(result.clocks),
        seconds(result.seconds),
        result.clock_hz as f64 / 1e6,
        seconds(result.pixel_seconds),
        result.stepped_because.map_or(result.method.to_owned(), |why| format!("{} ({why})", result.method)),
        result.engine,
        result.engine_because.map_or(String::new(), |why| format!(" ({why})")),
        table(rows),
        percent(bus.busy, result.clocks),
        grouped(bus.moved),
        grouped(bus.transfers),
        grouped(bus.longest_wait),
    );
    text += &protections(result);
    text += &operation_times(&result.timing);
    text += &waits(&result.cores);
    // Caches and kinds of data, where the machine has them.
    let cache = &bus.cache;
    if cache.hits + cache.misses != 0 {
        text += &format!(
            "caches: {} of {} reads hit, {} octets filled instead of {}\n",
            percent(cache.hits, cache.hits + cache.misses),
            grouped(cache.hits + cache.misses),
            grouped(cache.filled),
            grouped(cache.asked),
        );
    }
    // With a cache, what is asked for is not what is moved: both are told, each in parts of its own sum.
    let asked: u64 = bus.kinds.0.iter().map(|(_, octets)| octets).sum();
    match &result.moved_kinds {
        moved if moved.0 == bus.kinds.0 => text += &by_kind("octets", moved, asked),
        moved => {
            text += &by_kind("octets asked for", &bus.kinds, asked);
            text += &by_kind("octets moved", moved, bus.moved + bus.aside);
        }
    }
    text
}

/// One line on the protections of the machine; nothing where it has none.
fn protections(result: &Render) -> String {
    let ProtectionUse { octets, storage_bits } = result.protection;
    match protection::named(&result.settings.machine.config) {
        names if names.is_empty() => names,
        names => format!(
            "protected: {names}; {} octets of check bits over the bus, {} bits stored\n",
            grouped(octets),
            grouped(storage_bits),
        ),
    }
}

/// One line on the clocks and units that a machine's laws come to; nothing for a machine of numbers alone.
pub fn operation_times(times: &OperationTimes) -> String {
    if !times.is_by_word {
        return String::new();
    }
    let list = |counts: &ByClass, plain: u64| -> String {
        let other = counts.0.iter().filter(|&(_, number)| number != plain);
        other.map(|(class, number)| format!("{} {number}", class.name())).collect::<Vec<_>>().join(", ")
    };
    let units = match list(&times.units, 1) {
        none if none.is_empty() => String::new(),
        list => format!("; at once: {list}"),
    };
    format!("clocks of an operation on words of {} bits: {}{units}\n", times.word, list(&times.clocks, 0))
}

/// One line on octets by kind of data, in parts of all of them; nothing where there are none.
fn by_kind(what: &str, kinds: &ByKind, all: u64) -> String {
    let kinds = kinds.0.iter().filter(|(_, octets)| *octets != 0);
    let kinds: Vec<String> = kinds.map(|(kind, octets)| format!("{kind} {}", percent(*octets, all))).collect();
    if kinds.is_empty() { String::new() } else { format!("{what}: {}\n", kinds.join(", ")) }
}

/// Waits of the cores for the bus: the share of no wait, then bounds that so many waits keep.
fn waits(cores: &[ProcessorResult]) -> String {
    let columns = cores.iter().map(|core| core.waits.len()).max().unwrap_or(0);
    let count = |column: usize| cores.iter().filter_map(|core| core.waits.get(column)).sum::<u64>();
    let counts: Vec<u64> = (0..columns).map(count).collect();
    let total: u64 = counts.iter().sum();
    if total == 0 {
        return String::new();
    }
    // Column n ends before 2^n clocks.
    // For example counts 50, 30, 20: no wait in 50 of 100, so half of the waits end before 1 clock and nine of ten before 4.
    let bound = |share: f64| {
        let mut sum = 0;
        let is_reached = |&count: &u64| {
            sum += count;
            sum as f64 >= share * total as f64
        };
        1_u64 << counts.iter().position(is_reached).unwrap_or(columns)
    };
    format!(
        "waits of the cores: none {}, half below {}, nine of ten below {}, 99 of 100 below {} clocks\n",
        percent(counts[0], total),
        grouped(bound(0.5)),
        grouped(bound(0.9)),
        grouped(bound(0.99)),
    )
}

/// A time with a fitting unit.
pub fn seconds(time: f64) -> String {
    match time {
        time if time >= 1.0 => format!("{time:.2} s"),
        time if time >= 1e-3 => format!("{:.2} ms", time * 1e3),
        time => format!("{:.2} us", time * 1e6),
    }
}

/// The figures of the difference from double precision.
pub fn error(error: &PictureError) -> String {
    let decibels = |value: Option<f64>| value.map_or("none: equal".to_owned(), |value| format!("{value:.2} dB"));
    format!(
        "Difference from double precision\n\
         rmse {:.3e}, PSNR {}, largest {:.3e}\n\
         {} off by 1/255 or more ({:.1} per million); PSNR of the others {}\n",
        error.rmse,
        decibels(error.psnr_db),
        error.max,
        count(error.off_pixels, "pixel", "pixels"),
        error.off_per_million,
        decibels(error.psnr_others_db),
    )
}

/// The hashes by which runs are compared.
pub fn hashes(result: &Render) -> String {
    format!("image hash {}\nrun hash   {}\n", result.image_hash, result.run_hash)
}

/// A raw word with `fraction` bits behind the point (at most 32) as a decimal number: nine digits, rounded once from the exact value.
fn real(word: i32, fraction: u32) -> String {
    format!("{:.9}", I32F32::from_bits(i64::from(word) << (32 - fraction)))
}

/// The colour of a single pixel, raw and as numbers, beside the reference's.
pub fn pixel(drawing: &Drawing) -> String {
    let shown = |colour: [f64; 3]| colour.map(|component| format!("{component:.9}")).join(" ");
    let words = &drawing.words[0];
    let mut text = format!(
        "pixel {},{}: {} (raw {} with {} fraction bits)\n",
        drawing.crop.column,
        drawing.crop.row,
        words.map(|word| real(word, drawing.image.formats.colour)).join(" "),
        words.map(|word| word.to_string()).join(" "),
        drawing.image.formats.colour
    );
    if let Some(reference) = drawing.reference.as_ref().and_then(|picture| picture.pixels.first()) {
        text += &format!("double precision: {}\n", shown(*reference));
    }
    text
}

/// Spread of the operations over the pixels; a heat map goes from the least (dark) to the largest (bright).
pub fn spread(operations: &[u64]) -> String {
    let mut sorted = operations.to_vec();
    sorted.sort_unstable();
    let last = sorted.len().saturating_sub(1);
    let at = |place: usize| grouped(sorted.get(place).copied().unwrap_or(0));
    format!("least {}, median {}, largest {}", at(0), at(last / 2), at(last))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn real_values_are_those_of_double_precision() {
        let ends = [i32::MIN, i32::MIN + 1, -1, 0, 1, 3, 5, i32::MAX];
        let words = ends.into_iter().chain((0..1 << 16).map(|n| n << 15 | 1 << 9));
        for (word, fraction) in words.flat_map(|word| (0..=32).map(move |fraction| (word, fraction))) {
            let exact = f64::from(word) * (-f64::from(fraction)).exp2();
            assert_eq!(real(word, fraction), format!("{exact:.9}"), "{word} with {fraction} bits");
        }
    }
}
