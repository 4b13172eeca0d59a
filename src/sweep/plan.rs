//! A plan: the points of a study, each with its hash and that of its recording. As a file it has a line that says what all points share, and a
//! line a point.

use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use messages::{Diagnostic, Report};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::contents::Contents;
use super::digest::{PointDigest, StudyDigests};
use super::identity::PartDigest;
use super::key_set::KeySet;
use super::study::{Assignments, MOST_POINTS, Study, ordered};
use super::{PLAN, identity};
use crate::failure::Failure;
use crate::files;
use crate::settings::apply::change;
use crate::settings::{Settings, VERSION};

/// Lines of a plan that are written at once.
const LINES: usize = 1024;

/// Octets of the largest plan.
const LARGEST: u64 = 4 << 30;

/// The first line of a plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanHead {
    /// [`PLAN`].
    pub schema: String,
    /// Version of the program that has planned, and must run.
    pub version: String,
    /// Name of the study.
    pub study: String,
    /// Points, each once.
    pub points: u64,
    /// Points of the study that are the same as one before.
    pub repeated: u64,
    /// Recordings that the points need.
    pub recordings: u64,
    /// Seconds that a host of two threads takes for all, very roughly.
    pub seconds: f64,
    /// Settings of every point before its own.
    pub settings: Value,
}

/// A point of a plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlannedPoint {
    /// SHA-256 of all that the point's result depends on, in hexadecimal.
    pub point: String,
    /// SHA-256 of what its recording depends on, in hexadecimal.
    pub recording: String,
    /// Keys that the point sets.
    pub set: KeySet,
}

/// Octets of the shortest line of a point, as it is written.
const LEAST_LINE: usize = r#"{"point":"","recording":"","set":{}}"#.len();

/// Points with what they share.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyPlan {
    /// The first line.
    pub head: PlanHead,
    /// The points in the order of the study.
    pub points: Vec<PlannedPoint>,
}

/// Nanoseconds of a host thread that a pixel's recording, and its reference, take; measured on sphereflake, and good to a factor of a few.
const RECORDING: f64 = 40_000.0;

/// Nanoseconds of a host thread that putting a recorded pixel on a machine's clocks takes.
const REPLAY: f64 = 10_000.0;

impl StudyPlan {
    /// The points of a study. Reads the files that they depend on.
    ///
    /// # Errors
    /// Files that cannot be read, and points whose values are out of their ranges or do not go together.
    pub fn new(study: &Study, contents: &Contents) -> Result<StudyPlan, Failure> {
        // Digest all points on all threads; only the digests are kept until the lines are written.
        let all = StudyDigests::new(study, contents);
        // The first point that cannot be is told; those behind it need not be tried, which all of a study may have in common.
        let refused = AtomicU64::new(u64::MAX);
        let of = |number: u64| {
            let is_before = number < refused.load(Ordering::Relaxed);
            is_before.then(|| {
                let digest = all.of(number);
                if digest.is_err() {
                    refused.fetch_min(number, Ordering::Relaxed);
                }
                digest
            })
        };
        let digests: Vec<Option<Result<PointDigest, Failure>>> = (0..study.count()).into_par_iter().map(of).collect();
        let mut seen = HashSet::with_capacity(digests.len());
        let mut recordings: HashMap<[u8; 32], u64> = HashMap::new();
        let (mut points, mut repeated, mut nanoseconds) = (Vec::new(), 0, 0.0);
        for (number, digest) in digests.into_iter().flatten().enumerate() {
            let (PartDigest { point, recording }, pixels) = digest?;
            if !seen.insert(point) {
                repeated += 1;
                continue;
            }
            if recordings.insert(recording, pixels).is_none() {
                nanoseconds += RECORDING * pixels as f64;
            }
            nanoseconds += REPLAY * pixels as f64;
            points.push(PlannedPoint {
                point: identity::shown(&point),
                recording: identity::shown(&recording),
                set: study.assignments(number as u64).into_iter().collect(),
            });
        }
        let head = PlanHead {
            schema: PLAN.to_owned(),
            version: VERSION.to_owned(),
            study: study.name.clone(),
            points: points.len() as u64,
            repeated,
            recordings: recordings.len() as u64,
            // Two threads, and a hundredth of a second is enough.
            seconds: (nanoseconds / 2.0 / 1e7).round() / 100.0,
            settings: study.base.clone(),
        };
        Ok(StudyPlan { head, points })
    }

    /// The plan as octets, some lines at a time.
    pub fn octets(&self) -> impl Iterator<Item = Vec<u8>> {
        fn put(octets: &mut Vec<u8>, line: &impl Serialize) {
            serde_json::to_writer(&mut *octets, line).expect("plans have string keys");
            octets.push(b'\n');
        }
        let mut head = Vec::new();
        put(&mut head, &self.head);
        let lines = self.points.chunks(LINES).map(|points| {
            let mut octets = Vec::new();
            points.iter().for_each(|point| put(&mut octets, point));
            octets
        });
        std::iter::once(head).chain(lines)
    }

    /// Reads a plan.
    ///
    /// # Errors
    /// A file that is no plan or only a part of one, or one of another version.
    pub fn read(path: &Path) -> Result<StudyPlan, Report> {
        let text = files::text(files::read_up_to(LARGEST, path)?);
        StudyPlan::parse(&text, &files::shown(path))
    }

    /// Reads the text of a plan; `name` stands in messages.
    ///
    /// # Errors
    /// See [`StudyPlan::read`].
    pub fn parse(text: &str, name: &str) -> Result<StudyPlan, Report> {
        let mut lines = (1..).zip(text.lines());
        let hint = "`lancer sweep plan study.toml > plan.jsonl` makes one";
        let refuse = |what: String| Report::from(Diagnostic::error(format!("{name} is no plan: {what}")).hint(hint));
        let (_, first) = lines.next().ok_or_else(|| refuse("it is empty".into()))?;
        let head: PlanHead = serde_json::from_str(first).map_err(|error| refuse(format!("line 1: {error}")))?;
        if head.schema != PLAN {
            return Err(refuse(format!("its first line says `{}`, not `{PLAN}`", head.schema)));
        }
        if head.version != VERSION {
            let message = format!("{name} was planned by version {}, and this is {VERSION}", head.version);
            return Err(Diagnostic::error(message).hint("plan again: results of two versions are no one study").into());
        }
        if head.points > MOST_POINTS {
            return Err(refuse(format!("it has {} points", head.points)));
        }
        // Room for as many as the rest can hold, whatever the first line says.
        let mut points = Vec::with_capacity((head.points as usize).min(text.len() / LEAST_LINE));
        for (number, line) in lines {
            points.push(serde_json::from_str(line).map_err(|error| refuse(format!("line {number}: {error}")))?);
        }
        if points.len() as u64 != head.points {
            let message = format!("it has {} points of the {} that its first line says", points.len(), head.points);
            return Err(refuse(message));
        }
        Ok(StudyPlan { head, points })
    }

    /// Settings of a point, with the contents that they stand for.
    ///
    /// # Errors
    /// Contents that are not those of the plan.
    pub fn settings(&self, point: &PlannedPoint, contents: &Contents) -> Result<Settings, Failure> {
        let assignments = ordered(point.set.iter().map(|(key, value)| (key.to_owned(), value.clone())).collect());
        let settings = settings_of(&self.head.settings, &assignments, contents)?;
        if identity::shown(&identity::point(&settings)) != point.point {
            let short: String = point.point.chars().take(16).collect();
            let message = format!("point {short} is not what was planned: a file has changed since");
            return Err(Diagnostic::error(message).hint("plan again").into());
        }
        Ok(settings)
    }

    /// Numbers of the points that share each recording, in the order of the plan.
    pub fn groups(&self) -> Vec<Vec<usize>> {
        let (mut groups, mut known): (Vec<Vec<usize>>, HashMap<&str, usize>) = (Vec::new(), HashMap::new());
        for (number, point) in self.points.iter().enumerate() {
            let group = *known.entry(&point.recording).or_insert(groups.len());
            if group == groups.len() {
                groups.push(Vec::new());
            }
            groups[group].push(number);
        }
        groups
    }
}

impl Study {
    /// Settings of a point by its number, with what goes by the scene and the hashes of all files.
    ///
    /// # Errors
    /// Files that cannot be read, values out of their ranges or that do not go together.
    pub fn settings(&self, number: u64, contents: &Contents) -> Result<Settings, Failure> {
        settings_of(&self.base, &self.assignments(number), contents)
    }
}

/// Settings with what a point sets.
fn settings_of(base: &Value, assignments: &Assignments, contents: &Contents) -> Result<Settings, Failure> {
    let mut value = base.clone();
    for (key, assigned) in assignments {
        change(&mut value, key, assigned.clone())?;
    }
    let mut settings = Settings::of_value(&value)?;
    let told = |failure: Failure| match failure {
        Failure::Message { report, exit } => Failure::Message {
            report: Report(report.0.into_iter().map(|message| blamed(message, assignments)).collect()),
            exit,
        },
        other => other,
    };
    contents.resolve(&mut settings).map_err(told)?;
    Ok(settings)
}

fn blamed(message: Diagnostic, assignments: &Assignments) -> Diagnostic {
    let point: Vec<String> = assignments.iter().map(|(key, value)| format!("{key}={value}")).collect();
    Diagnostic { message: format!("{} (point {})", message.message, point.join(" ")), ..message }
}

#[cfg(test)]
mod tests {
    use messages::Source;

    use super::*;

    fn plan(text: &str) -> StudyPlan {
        let study =
            Study::parse(&Source::new("s.toml", text), "s").unwrap_or_else(|report| panic!("{}", report.render(false)));
        StudyPlan::new(&study, &Contents::default()).unwrap_or_else(|failure| panic!("{failure:?}"))
    }

    const TEXT: &str = "settings = { size = \"4x3\" }\n[product]\nscene = [\"triangle\", \"cornell\"]\nword = [32, 24]\n\
                        machine = [\"report\", \"wide32\", \"node_cache\"]\ncores = \"1-3\"\n";

    #[test]
    fn points_that_differ_in_what_is_replayed_share_a_recording() {
        let plan = plan(TEXT);
        assert_eq!((plan.head.points, plan.head.recordings), (2 * 2 * 3 * 3, 2 * 2 * 2));
        let groups = plan.groups();
        assert_eq!(groups.iter().map(Vec::len).sum::<usize>(), 36);
        assert_eq!(groups.len(), 8);
    }

    #[test]
    fn the_order_of_a_study_and_names_change_no_hash() {
        let first = plan(TEXT);
        let second = plan(
            "[product]\ncores = [3, 2, 1]\nscene = [\"cornell\", \"triangle\"]\nbus.octets_per_beat = 1\n\
             machine = [\"node_cache\", \"wide32\", { name = \"mine\" }]\nword = [24, 32]\n[settings]\nengine = \"checked\"\nview.size = [4, 3]\n",
        );
        // The key that is set in every point changes `wide32`, which has another bus.
        let hashes = |plan: &StudyPlan| plan.points.iter().map(|point| point.point.clone()).collect::<HashSet<_>>();
        let (first, second) = (hashes(&first), hashes(&second));
        assert_eq!(first.intersection(&second).count(), 2 * 2 * 2 * 3);
    }

    #[test]
    fn a_point_whose_hash_is_none_is_refused() {
        let mut plan = plan(TEXT);
        for hash in ["", "mine", "é".repeat(16).as_str()] {
            plan.points[0].point = hash.to_owned();
            let refused = plan.settings(&plan.points[0], &Contents::default());
            assert!(refused.is_err(), "{hash}");
        }
    }

    #[test]
    fn a_plan_reads_back_as_itself() {
        let plan = plan(TEXT);
        let octets = plan.octets().collect::<Vec<_>>().concat();
        let text = String::from_utf8(octets).unwrap();
        assert_eq!(StudyPlan::parse(&text, "plan.jsonl").unwrap(), plan);
        for (cut, message) in [(text.lines().count() - 1, "35 points of the 36"), (0, "it is empty")] {
            let part: String = text.lines().take(cut).map(|line| format!("{line}\n")).collect();
            assert!(StudyPlan::parse(&part, "p").unwrap_err().render(false).contains(message));
        }
        assert!(StudyPlan::parse(&text[..text.len() - 20], "p").unwrap_err().render(false).contains("line 37"));
    }
}
