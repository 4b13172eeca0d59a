//! The arithmetic: word, modes and formats.

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use emu::machine::Config;
use isa::number::{Overflow, Quantization};

use super::overrides;

/// Options of the arithmetic.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Numbers")]
pub struct NumberArguments {
    #[command(flatten)]
    #[allow(missing_docs, reason = "the group has its own")]
    pub arithmetic: ArithmeticArguments,
    #[command(flatten)]
    #[allow(missing_docs, reason = "the group has its own")]
    pub formats: FormatArguments,
}

/// Option of the fraction bits.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Numbers")]
pub struct FormatArguments {
    /// Fraction bits of pos, dir, bary, t, weight or colour; may be repeated [default: by the scene].
    #[arg(long = "format", value_name = "QUANTITY=BITS", value_delimiter = ',', value_parser = overrides::check)]
    pub formats: Vec<String>,
}

/// Options of the word and of the modes.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Numbers")]
pub struct ArithmeticArguments {
    /// Bits of a word, 8 to 32 [default: the machine's, 32].
    #[arg(long, value_name = "BITS", value_parser = clap::value_parser!(u32).range(8..=32))]
    pub word: Option<u32>,
    /// Rounding mode, by its IEEE 1666 name [default: the machine's, RND].
    #[arg(long, value_name = "MODE", ignore_case = true, value_parser = rounding())]
    pub rounding: Option<Quantization>,
    #[command(flatten)]
    #[allow(missing_docs, reason = "the group has its own")]
    pub overflow: OverflowArguments,
}

/// Option of the overflow mode.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Numbers")]
pub struct OverflowArguments {
    /// Overflow mode, by its IEEE 1666 name: SAT, SAT_ZERO, SAT_SYM, WRAP or WRAP_SM; WRAP:3 saturates three bits
    /// [default: the machine's, SAT].
    #[arg(long, value_name = "MODE", value_parser = overflow)]
    pub overflow: Option<Overflow>,
}

impl ArithmeticArguments {
    /// Changes what the options say otherwise than the machine.
    pub fn adjust(&self, config: &mut Config) {
        let arithmetic = &mut config.arithmetic;
        arithmetic.word = self.word.unwrap_or(arithmetic.word);
        arithmetic.quantization = self.rounding.unwrap_or(arithmetic.quantization);
        arithmetic.overflow = self.overflow.overflow.unwrap_or(arithmetic.overflow);
    }
}

fn rounding() -> impl TypedValueParser<Value = Quantization> {
    let names = PossibleValuesParser::new(Quantization::ALL.iter().map(|mode| mode.name()));
    names.map(|name| Quantization::from_name(&name).expect("the parser lets only names pass"))
}

fn overflow(text: &str) -> Result<Overflow, String> {
    let names: Vec<&str> = Overflow::ALL.iter().map(|mode| mode.name()).collect();
    Overflow::from_name(text).ok_or_else(|| {
        let most = Overflow::MOST_SATURATED;
        format!("it is one of {}, the last two also with 1 to {most} saturated bits as in WRAP:3", names.join(", "))
    })
}
