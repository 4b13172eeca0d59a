//! The unit, how far it is from the body beside it, and a picture for each size of its table.

use std::fmt::Write;

use asm::extension;
use emu::conformance::{self, Trial};
use emu::extension::{Call, Ending, Meaning, attach};
use emu::trap::Fault;
use isa::Isa;
use isa::number::Arithmetic;
use kernels::Function;
use lancer::drawing::{self, Comparison};
use lancer::failure::Failure;
use lancer::job::Job;
use messages::{Report, Source};
use scenes::generate;

const ROW: &str = include_str!("reciprocal.isa");
const KERNEL: &str = include_str!("unit.s");

/// Multiplies by a reciprocal of `bits` bits and rounds by chance.
#[derive(Clone, Debug)]
pub struct Reciprocal {
    pub bits: u32,
    /// A shift register with feedback. It starts alike in each pixel, so that a picture does not depend on who draws which.
    pub noise: u32,
}

impl Reciprocal {
    fn chance(&mut self) -> u32 {
        for _ in 0..32 {
            self.noise = self.noise >> 1 ^ if self.noise & 1 == 1 { 0xa300_0000 } else { 0 };
        }
        self.noise
    }
}

impl Meaning for Reciprocal {
    fn execute(&mut self, call: &mut Call) -> Result<Ending, Fault> {
        let (a, fraction) = (call.operands.vector('a'), call.operands.immediate('i'));
        let square = call.arithmetic.widen_products(a.map(|component| i64::from(component) * i64::from(component)));
        let length = call.arithmetic.root(square as u128);
        if length == 0 {
            call.set_vector('d', a.map(|component| call.arithmetic.quotient(i128::from(component) << fraction, 0)));
            return Ok(Ending::DONE);
        }
        let shift = self.bits + length.ilog2();
        let reciprocal = ((2i128 << shift) / i128::from(length) + 1) >> 1;
        let mut component = |component: i32| {
            let product = (i128::from(component) * reciprocal) << fraction;
            let chance = i128::from(self.chance()) << shift >> 32;
            call.arithmetic.narrow((product + chance) >> shift, 0)
        };
        let unit = [component(a[0]), component(a[1]), component(a[2])];
        call.set_vector('d', unit);
        Ok(Ending::DONE)
    }
}

/// The instructions with the unit, for a table of so many bits.
pub fn isa(bits: u32) -> Result<Isa, Report> {
    let mut isa = Isa::base();
    let source = Source::new("reciprocal.isa", ROW);
    extension::load(&mut isa, &source, &|_, _| Err("nothing is included".into()))?;
    attach(&mut isa, "vunit", Reciprocal { bits, noise: 1 }).map_err(|why| Report::from(*why))?;
    Ok(isa)
}

/// The Cornell box with the unit.
pub fn job(bits: u32) -> Result<Job, Report> {
    let scene = generate::scene("cornell", &generate::GenerateOptions { size: (24, 18), ..Default::default() });
    let mut job = Job::new(scene.expect("it is generated"));
    job.isa = isa(bits)?;
    job.kernels.replaced.push((Function::Unit, Source::new("unit.s", KERNEL)));
    Ok(job)
}

/// A table: size, largest difference from the body on random vectors, and what is left of the picture.
pub fn report() -> Result<String, Failure> {
    let mut text = String::from("bits   largest difference   pixels off   PSNR of the others      clocks\n");
    for bits in [6, 8, 10, 12, 16, 20] {
        let job = job(bits)?;
        // Units with 16 fraction bits are at most 2^16: the table's error, and one for the rounding by chance.
        let tolerance = (1 << 16 >> bits) + 2;
        let trial = Trial { immediates: vec![('i', 16)], tolerance, ..Trial::default() };
        let found = conformance::check(&job.isa, "vunit", &trial).map_err(|mismatch| mismatch.diagnostic())?;
        let drawing = drawing::draw(&job, Comparison::Reference, &mut |_| {})?;
        let error = drawing.error.expect("the reference has the size of the picture");
        let psnr = error.psnr_others_db.unwrap_or(f64::INFINITY);
        let (off, clocks) = (error.off_pixels, drawing.frame.clocks.0);
        let _ = writeln!(text, "{bits:>4} {:>20} {off:>12} {psnr:>17.2} dB {clocks:>11}", found.largest);
    }
    Ok(text)
}
