//! Options that say how much is computed.

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use kernels::{Skip, Skips};

use super::{TreeArguments, value};

/// Options of the effort.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Effort")]
pub struct EffortArguments {
    /// Levels of reflected and refracted rays below the camera ray, 0 to 30.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=30), default_value = "5")]
    pub bounces: u32,
    #[command(flatten)]
    #[allow(missing_docs, reason = "the group has its own")]
    pub tree: TreeArguments,
    /// Weight that a reflected or refracted ray must exceed to be followed, 0 to 1.
    #[arg(long, value_name = "WEIGHT", value_parser = weight, allow_hyphen_values = true, default_value = "0")]
    pub weight_cutoff: f64,
    #[command(flatten)]
    #[allow(missing_docs, reason = "the group has its own")]
    pub skips: SkipArguments,
    /// Interpolates pixels between four corners that differ by at most this in each component, 0 to 1 (without a number: 0.01).
    #[arg(long, value_name = "DIFFERENCE", value_parser = difference, num_args = 0..=1, require_equals = true, default_missing_value = "0.01")]
    pub interpolate: Option<f64>,
}

/// Option of what the kernels leave out.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Effort")]
pub struct SkipArguments {
    /// Skips not to make, names between commas, or `all`; `lancer skips` lists them and what they save.
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', value_parser = unskipped())]
    pub no_skip: Vec<Vec<Skip>>,
}

impl SkipArguments {
    /// The skips of the program.
    pub fn skips(&self) -> Skips {
        self.no_skip.iter().flatten().fold(Skips::ALL, |skips, &skip| skips.without(skip))
    }
}

fn unskipped() -> impl TypedValueParser<Value = Vec<Skip>> {
    let names = Skip::ALL.iter().map(|skip| PossibleValue::new(skip.name()).help(skip.description()));
    let all = PossibleValue::new("all").help("All of these");
    PossibleValuesParser::new(names.chain([all])).map(|name| match name.parse() {
        Ok(skip) => vec![skip],
        Err(_) => Skip::ALL.to_vec(),
    })
}

fn difference(text: &str) -> Result<f64, String> {
    let [difference] = value::point(text)?;
    if (0.0..=1.0).contains(&difference) { Ok(difference) } else { Err("a difference lies in 0 to 1".into()) }
}

fn weight(text: &str) -> Result<f64, String> {
    let [weight] = value::point(text)?;
    if (0.0..=1.0).contains(&weight) { Ok(weight) } else { Err("a weight lies in 0 to 1".into()) }
}
