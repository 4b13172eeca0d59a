//! Claims held against what happened.

use super::Case;
use super::claim::{Claim, Subject};
use super::observation::{Observation, Said};

/// Change that would make a comment right.
#[derive(Clone, Debug)]
pub enum Remedy {
    /// Another claim, which takes its place.
    Replace(Claim),
    /// The claim left out.
    Remove,
    /// One more claim.
    Add(Claim),
    /// None: the program itself has to change.
    None,
}

/// One thing that is not as it is claimed.
#[derive(Clone, Debug)]
pub struct Difference {
    /// Line from 1; 0 for what has none.
    pub line: usize,
    /// Comment and claim in it; `None` for what nobody claimed.
    pub claim: Option<(usize, usize)>,
    /// For a person.
    pub problem: String,
    /// Change that would make it right.
    pub remedy: Remedy,
}

/// All differences between a case's claims and what it did.
pub fn differences(case: &Case, observation: &Observation) -> Vec<Difference> {
    let mut found = Vec::new();
    let mut unclaimed = observation.said.clone();
    let mut unsaid = Vec::new();
    let places = case.comments.iter().enumerate().flat_map(|(comment, comment_claims)| {
        comment_claims.claims.iter().enumerate().map(move |(at, claim)| ((comment, at), comment_claims.line, claim))
    });
    // Compare each claim; one about a message takes the message that says just this, others wait until all have been asked
    for (place, line, claim) in places {
        let mut differ = |problem, remedy| found.push(Difference { line, claim: Some(place), problem, remedy });
        let value = match (&claim.subject, &observation.run) {
            (Subject::Said(head), _) => {
                match unclaimed.iter().position(|said| is_claimed(said, claim, head)) {
                    Some(at) => _ = unclaimed.remove(at),
                    None => unsaid.push((place, line, claim)),
                }
                continue;
            }
            (_, None) => Err("the program does not run".to_owned()),
            (_, Some(run)) => run.value(claim),
        };
        match value {
            Ok(value) if value == claim.value => {}
            Ok(value) => {
                let right = claim.with_value(value);
                differ(format!("`{claim}`, but `{right}`"), Remedy::Replace(right));
            }
            Err(why) => differ(format!("`{claim}`: {why}"), Remedy::None),
        }
    }
    // Give each claim that waits a message that is left on its line: where `a` and `b` are said, claims `x` and `a` become `b` and `a`
    for (place, line, claim) in unsaid {
        let (problem, remedy) = match unclaimed.iter().position(|said| said.line == claim.line) {
            Some(at) => {
                let right = claim_of(&unclaimed.remove(at), claim.names_line);
                (format!("`{claim}`, but `{right}`"), Remedy::Replace(right))
            }
            None => (format!("`{claim}` is not said"), Remedy::Remove),
        };
        found.push(Difference { line, claim: Some(place), problem, remedy });
    }
    // Messages that nobody claims are to be added
    for said in unclaimed {
        let claim = claim_of(&said, false);
        let problem = format!("`{claim}` is not expected");
        found.push(Difference { line: said.line, claim: None, problem, remedy: Remedy::Add(claim) });
    }
    found.sort_by_key(|difference| difference.line);
    found
}

fn is_claimed(said: &Said, claim: &Claim, head: &str) -> bool {
    let is_text = match claim.value.strip_suffix("...") {
        Some(beginning) => said.text.starts_with(beginning),
        None => said.text == claim.value,
    };
    said.line == claim.line && said.head == head && is_text
}

fn claim_of(said: &Said, names_line: bool) -> Claim {
    Claim { subject: Subject::Said(said.head.clone()), value: said.text.clone(), line: said.line, names_line }
}
