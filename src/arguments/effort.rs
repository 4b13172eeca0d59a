//! How much is computed.

use clap::Args;

use super::value;

/// Options of the effort.
#[derive(Args, Clone, Copy, Debug)]
#[command(next_help_heading = "Effort")]
pub struct EffortArguments {
    /// Levels of reflected and refracted rays below the camera ray, 0 to 30.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=30), default_value = "5")]
    pub bounces: u32,
    /// Levels of the kd tree below its root, 0 to 40.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=40), default_value = "16")]
    pub kd_depth: u32,
    /// Weight that a reflected or refracted ray must exceed to be followed, 0 to 1.
    #[arg(long, value_name = "WEIGHT", value_parser = weight, allow_hyphen_values = true, default_value = "0")]
    pub weight_cutoff: f64,
}

fn weight(text: &str) -> Result<f64, String> {
    let [weight] = value::point(text)?;
    if (0.0..=1.0).contains(&weight) { Ok(weight) } else { Err("a weight lies in 0 to 1".into()) }
}
