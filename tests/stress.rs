//! The catalogue of `lancer stress`, with as many trials as the command makes by default.

use lancer::stress::{CASES, CatalogueSize, TrialTally};

#[test]
fn every_case_passes() {
    for case in CASES {
        let tally = case.run(CatalogueSize::Quick, 0..case.trials(CatalogueSize::Quick));
        assert_eq!(tally.trials, case.trials(CatalogueSize::Quick), "{}", case.name);
        assert!(case.passes(&tally), "{}: {tally:?}", case.name);
    }
}

#[test]
fn a_case_can_be_stopped_and_taken_up() {
    for case in CASES.iter().filter(|case| case.trials(CatalogueSize::Quick) >= 10_000) {
        let parts = [0..10, 10..11, 11..100].map(|part| case.run(CatalogueSize::Quick, part));
        let together = parts.into_iter().fold(TrialTally::default(), TrialTally::plus);
        assert_eq!(together, case.run(CatalogueSize::Quick, 0..100), "{}", case.name);
    }
}
