//! Property tests that try the same cases on every run and leave no files behind.

use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

/// A runner of `cases` cases with the seed that proptest keeps for this.
pub fn runner(cases: u32) -> TestRunner {
    TestRunner::new_with_rng(config(cases), TestRng::deterministic_rng(RngAlgorithm::ChaCha))
}

/// A runner of `cases` cases with a seed of the caller's.
pub fn seeded_runner(cases: u32, seed: &[u8; 32]) -> TestRunner {
    TestRunner::new_with_rng(config(cases), TestRng::from_seed(RngAlgorithm::ChaCha, seed))
}

fn config(cases: u32) -> Config {
    Config { cases, failure_persistence: None, ..Config::default() }
}

/// Tries a property on `cases` values.
///
/// # Panics
/// With the smallest value found for which it does not hold.
pub fn check<S: Strategy>(cases: u32, strategy: &S, property: impl Fn(S::Value) -> Result<(), TestCaseError>) {
    if let Err(failure) = runner(cases).run(strategy, property) {
        panic!("{failure}");
    }
}
