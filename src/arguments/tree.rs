//! Options of the kd tree.

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use scenes::kdtree::{BuildMethod, DEEPEST, Depth, VISIT};

use crate::settings::TreeSettings;

/// Options of the kd tree.
#[derive(Args, Clone, Copy, Debug)]
pub struct TreeArguments {
    /// Levels of the kd tree below its root, 0 to 40; `auto` for 8 + 1.3 log2 of the number of triangles [default: auto; 16 with the report's
    /// kernels, or layout where there are none].
    #[arg(long, value_name = "N", value_parser = depth)]
    pub kd_depth: Option<Depth>,
    /// Triangles that a node of the kd tree holds: `report` goes by their boxes, `exact` by what of them lies in the node, `binned` as well, with planes
    /// found sooner and a bound on the references [default: binned; report with the report's kernels, or layout where there are none].
    #[arg(long, value_name = "METHOD", value_parser = method())]
    pub kd_build: Option<BuildMethod>,
    /// Cost of visiting a node of the kd tree in percent of testing a triangle, 1 to 100, by which `binned` chooses planes: the lower, the more nodes and
    /// the fewer tests.
    #[arg(long, value_name = "PERCENT", value_parser = clap::value_parser!(u32).range(1..=i64::from(VISIT)), default_value_t = VISIT)]
    pub kd_visit: u32,
}

impl TreeArguments {
    /// The settings that they stand for.
    pub fn settings(&self) -> TreeSettings {
        TreeSettings { depth: self.kd_depth, build: self.kd_build, visit: self.kd_visit }
    }
}

fn depth(text: &str) -> Result<Depth, String> {
    match text.parse() {
        Ok(levels @ 0..=DEEPEST) => Ok(Depth::Levels(levels)),
        _ if text == "auto" => Ok(Depth::Auto),
        _ => Err(format!("a number from 0 to {DEEPEST} or `auto` is expected")),
    }
}

fn method() -> impl TypedValueParser<Value = BuildMethod> {
    let names = PossibleValuesParser::new(BuildMethod::ALL.map(BuildMethod::name));
    names.map(|name| *BuildMethod::ALL.iter().find(|m| m.name() == name).expect("the parser lets only names pass"))
}
