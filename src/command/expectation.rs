//! Expectations of a picture that a script may have: `--expect-hash`, `--min-psnr`, `--max-clocks`.

use clap::Args;
use messages::{Diagnostic, Report};

use crate::arguments::positive;
use crate::numeral::grouped;
use crate::result::Render;

/// Fewest digits of a hash that is expected.
const FEWEST_DIGITS: usize = 8;

/// Options of what is expected.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Expectations (exit code 4 where one is not met)")]
pub struct ExpectationArguments {
    /// Hash of the picture or of the run, as results show them; its first 8 digits or more are enough.
    #[arg(long, value_name = "HASH", value_parser = hash)]
    expect_hash: Option<String>,
    /// Least PSNR against double precision, in dB; an equal picture meets any.
    #[arg(long, value_name = "DB", value_parser = decibels, allow_hyphen_values = true, conflicts_with = "no_error")]
    min_psnr: Option<f64>,
    /// Most clocks of the frame.
    #[arg(long, value_name = "N", value_parser = positive)]
    max_clocks: Option<u64>,
}

fn hash(text: &str) -> Result<String, String> {
    let digits = text.trim().to_ascii_lowercase();
    let is_hash = (FEWEST_DIGITS..=64).contains(&digits.len()) && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    if is_hash { Ok(digits) } else { Err(format!("{FEWEST_DIGITS} to 64 hexadecimal digits are expected")) }
}

fn decibels(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| "a number of decibels is expected".to_owned())
}

impl ExpectationArguments {
    /// One message for each expectation that a picture does not meet.
    pub fn unmet(&self, result: &Render) -> Report {
        let mut messages = Vec::new();
        if let Some(expected) = &self.expect_hash
            && ![&result.image_hash, &result.run_hash].iter().any(|hash| hash.starts_with(expected))
        {
            let message = format!("the hash {expected} was expected, of the picture or of the run");
            let hint = format!("the picture has {}, the run {}", result.image_hash, result.run_hash);
            messages.push(Diagnostic::error(message).hint(hint));
        }
        let psnr = result.error.as_ref().and_then(|error| error.psnr_db);
        if let Some((least, psnr)) = self.min_psnr.zip(psnr).filter(|(least, psnr)| psnr < least) {
            messages.push(Diagnostic::error(format!("the PSNR is {psnr:.2} dB, at least {least} dB were expected")));
        }
        if let Some(most) = self.max_clocks.filter(|&most| result.clocks > most) {
            let (clocks, most) = (grouped(result.clocks), grouped(most));
            messages.push(Diagnostic::error(format!("the frame takes {clocks} clocks, at most {most} were expected")));
        }
        Report(messages)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hashes_have_enough_digits_and_decibels_are_numbers() {
        assert_eq!(hash("0123ABCD"), Ok("0123abcd".to_owned()));
        for text in ["0123abc", "0123abcg", "", &"0".repeat(65)] {
            assert!(hash(text).is_err(), "{text}");
        }
        assert_eq!(decibels("-3.5"), Ok(-3.5));
        assert!(decibels("inf").is_err() && decibels("much").is_err());
    }
}
