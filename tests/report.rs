//! The page on the report names what is there: kernels, rows of the annexes with their printed labels, and commands that the command line
//! knows.

use std::path::{Path, PathBuf};

use clap::CommandFactory;
use kernels::annex::{PrintedErratum, errata, printed, rows};
use lancer::annex::as_printed::{ErratumPicture, PicturePair, compare, jobs};
use lancer::annex::measure;
use lancer::command::Lancer;
use lancer::drawing::draw;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The cells of the lines of the table below a heading, without its head.
fn table(text: &str, heading: &str) -> Vec<Vec<String>> {
    let part = text.split(heading).nth(1).unwrap_or_else(|| panic!("there is no {heading}"));
    let lines = part.lines().skip_while(|line| !line.starts_with('|')).take_while(|line| line.starts_with('|'));
    lines.skip(2).map(|line| line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()).collect()
}

/// The words of a cell between back ticks.
fn quoted(cell: &str) -> Vec<&str> {
    cell.split('`').skip(1).step_by(2).collect()
}

fn has_kernel(name: &str) -> bool {
    Path::exists(&root().join(format!("kernels/asm/report/{name}.s")))
}

#[test]
fn the_page_names_rows_kernels_and_commands_that_are_there() {
    let text = std::fs::read_to_string(root().join("docs/report.md")).unwrap();
    let sections = table(&text, "## Sections");
    assert!(sections.len() > 10, "{sections:?}");
    let mut of_sections = Vec::new();
    for line in &sections {
        let [_, _, _, kernels, command, counted] = &line[..] else { panic!("{line:?}") };
        for kernel in quoted(kernels) {
            assert!(has_kernel(kernel), "there is no kernel {kernel}");
        }
        of_sections.extend(quoted(counted));
        let command = quoted(command)[0];
        let parsed = Lancer::command().try_get_matches_from(command.split_whitespace());
        assert!(parsed.is_ok(), "{command}: {}", parsed.unwrap_err());
    }
    for line in table(&text, "## Figures") {
        let command = quoted(&line[2])[0];
        assert!(Lancer::command().try_get_matches_from(command.split_whitespace()).is_ok(), "{command}");
    }
    let listed = table(&text, "## Rows of the annexes");
    assert_eq!(listed.len(), rows().len());
    for (line, row) in listed.iter().zip(rows()) {
        assert_eq!((line[0].trim_matches('`'), line[1].as_str()), (row.id.as_str(), row.label.as_str()));
        let kernel = quoted(&line[3])[0];
        assert!(has_kernel(kernel), "there is no kernel {kernel}");
    }
    // Each row belongs to one section.
    let mut all: Vec<&str> = rows().iter().map(|row| row.id.as_str()).collect();
    all.sort_unstable();
    of_sections.sort_unstable();
    assert_eq!(of_sections, all);
}

/// The pictures of an erratum on its scene; `None` of a number.
fn pictures(erratum: &PrintedErratum) -> Option<PicturePair> {
    let name = erratum.scene.as_ref()?;
    let loaded = lancer::input::scene(name, None, Some((80, 60))).unwrap();
    let jobs = jobs(erratum, &loaded.scene, (80, 60))?;
    Some(compare(&jobs, &mut |job, comparison| draw(job, comparison, &mut |_| ())).unwrap().0)
}

/// Line of an erratum in the page's table.
fn line(erratum: &PrintedErratum, pair: Option<&PicturePair>) -> String {
    let picture = |of: &ErratumPicture| {
        let ratio = of.psnr_db.map_or_else(|| "equal".to_owned(), |ratio| format!("{ratio:.1} dB"));
        format!("{ratio}, {:.0} operations", of.operations)
    };
    let (on, [as_printed, corrected]) = match (pair, &erratum.figure) {
        (Some(pair), _) => (pair.scene.as_str(), [&pair.printed, &pair.correct].map(picture)),
        (None, Some(figure)) => {
            ("", [figure.printed, figure.correct].map(|number| format!("{number} {}", figure.unit)))
        }
        (None, None) => panic!("nothing shows {}", erratum.id),
    };
    let PrintedErratum { source, printed, correct, .. } = erratum;
    format!("| `{}` | {source} | {printed} | {correct} | {on} | {as_printed} | {corrected} |\n", erratum.name())
}

#[test]
fn the_table_of_errata_is_what_their_pictures_tell() {
    let pairs: Vec<_> = errata().iter().map(pictures).collect();
    let lines: String = errata().iter().zip(&pairs).map(|(erratum, pair)| line(erratum, pair.as_ref())).collect();
    let path = root().join("docs/report.md");
    let page = std::fs::read_to_string(&path).unwrap();
    let (before, rest) = page.split_once("## Errata\n").unwrap();
    let (words, table) = rest.split_once("|---|---|---|---|---|---|---|\n").unwrap();
    let end = table.find("\n\n").map_or("", |end| &table[end + 1..]);
    let end = if table.starts_with('\n') { table } else { end };
    let whole = format!("{before}## Errata\n{words}|---|---|---|---|---|---|---|\n{lines}{end}");
    match std::env::var_os("LANCER_BLESS") {
        Some(_) => std::fs::write(&path, whole).unwrap(),
        None => {
            assert!(page == whole, "docs/report.md is stale: LANCER_BLESS=1 cargo test -p lancer --test main -- errata")
        }
    }
    let found = |name: &str| {
        let at = errata().iter().position(|erratum| erratum.name() == name).unwrap();
        pairs[at].clone().unwrap()
    };
    let ratio = |name: &str| found(name).printed.psnr_db.unwrap();
    // Another tracer, which shares nothing with this one, has 20.6 dB, 29 to 30, and 38 to 47.
    assert!((19.0..22.0).contains(&ratio("first-hit")), "{}", ratio("first-hit"));
    assert!((24.0..32.0).contains(&ratio("refraction-root")), "{}", ratio("refraction-root"));
    assert!(ratio("strict-sides") < 47.0, "{}", ratio("strict-sides"));
    for (erratum, pair) in errata().iter().zip(&pairs).filter_map(|(erratum, pair)| Some((erratum, pair.as_ref()?))) {
        // What is wrong in the tree's cost and in its planes costs time; all other mistakes can be seen.
        let is_seen = !["division-cost", "best-plane", "products"].contains(&erratum.name().as_str());
        assert_eq!(
            pair.printed.psnr_db < pair.correct.psnr_db.map(|ratio| ratio - 1.0),
            is_seen,
            "{}: {pair:?}",
            erratum.id
        );
    }
}

/// Corrected numbers follow from the rows and from what is counted.
#[test]
fn corrected_numbers_are_counted() {
    let measured = measure().unwrap();
    let row = |id: &str| measured.iter().find(|measurement| measurement.row.id == id).unwrap();
    let total = |id: &str| row(id).row.printed.elementary() as f64;
    let (operations, clocks) = (printed("pixel_operations").unwrap(), printed("memory_clocks").unwrap());
    let figure = |name: &str| errata().iter().find(|erratum| erratum.name() == name).unwrap().figure.clone().unwrap();
    for (name, printed, correct) in [
        ("pixel-total", operations, total("rt.pixel")),
        ("normal", total("rt.normal"), row("rt.normal").most.elementary() as f64),
        ("reflected-ray", total("rt.ray_tree"), total("rt.ray_tree") + total("rt.make_reflected")),
        // 3 additions to 3 of the normal's own 6, 3 subtractions, 6 products and the division.
        ("reflected-normal", total("rt.make_reflected"), total("rt.make_reflected") - 16.0),
        ("searches", 66.0, row("rt.pixel").searches as f64),
        ("memory-clocks", clocks, 66.0 * 40.0 * 31.0 * 2.0),
        ("node-planes", 440.0, 440.0 - 6.0 * 32.0),
        ("tree-nodes", f64::from(1 << 16), f64::from((1 << 17) - 1)),
        ("ray-tree-octets", printed("buffer.ray_tree").unwrap() / 56.0, f64::from((1 << 6) - 1)),
        ("servers", 0.0, 1.0),
    ] {
        assert_eq!((figure(name).printed, figure(name).correct), (printed, correct), "{name}");
    }
    let processors = figure("processors");
    assert!((processors.printed - operations / clocks).abs() < 0.005);
    assert!((processors.correct - (operations + clocks) / clocks).abs() < 0.005);
}
