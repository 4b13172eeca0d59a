//! Shards: which recordings of a plan one of several processes runs, and which one this is where a scheduler says so.

use messages::{Diagnostic, Report};

/// Hint for whoever has to say which shard this is.
const ITSELF: &str = "`--shard I/N` says which one this is";

/// One of several shares of the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Number of the share, below `of`.
    pub index: u64,
    /// Number of all shares, at least 1.
    pub of: u64,
}

impl Shard {
    /// All of the work.
    pub const WHOLE: Shard = Shard { index: 0, of: 1 };

    /// Reads `I/N`. Shares are counted from 0 or from 1: N/N is the same as 0/N.
    ///
    /// # Errors
    /// Anything but two whole numbers, N at least 1 and I at most N.
    pub fn parse(text: &str) -> Result<Shard, String> {
        let refusal = || "a shard is I/N, such as 3/24: I of 0 to N".to_owned();
        let (index, of) = text.split_once('/').ok_or_else(refusal)?;
        let number = |text: &str| text.trim().parse::<u64>().map_err(|_| refusal());
        Shard::new(number(index)?, number(of)?).ok_or_else(refusal)
    }

    fn new(index: u64, of: u64) -> Option<Shard> {
        (of >= 1 && index <= of).then(|| Shard { index: index % of, of })
    }

    /// The shard that a scheduler's variables say, of `shards` where they do not say of how many: an array of Slurm (`SLURM_ARRAY_TASK_ID`, with
    /// `_MIN`, `_MAX` and `_STEP`), or an indexed Job of Kubernetes (`JOB_COMPLETION_INDEX`, `JOB_COMPLETIONS`). All of the work without them.
    ///
    /// # Errors
    /// A number without how many there are, one that is none, an array with gaps, or another number of shards than the variables say: then nothing says
    /// which share this is.
    pub fn of_environment(variable: &dyn Fn(&str) -> Option<String>, shards: Option<u64>) -> Result<Shard, Report> {
        let number = |name: &str| match variable(name) {
            None => Ok(None),
            Some(text) => text.trim().parse::<u64>().map(Some).map_err(|_| {
                Report::from(Diagnostic::error(format!("the variable {name} is `{text}`, which is no number")))
            }),
        };
        // Number 5 of `--array=1-7` is share 4 of 7; of `--array=1-7:2`, which has the numbers 1 3 5 7, it is share 2 of 4.
        let (index, said, name) = if let Some(task) = number("SLURM_ARRAY_TASK_ID")? {
            let (least, most) = (number("SLURM_ARRAY_TASK_MIN")?.unwrap_or(0), number("SLURM_ARRAY_TASK_MAX")?);
            let step = number("SLURM_ARRAY_TASK_STEP")?.unwrap_or(1).max(1);
            let place = |task: u64| task.saturating_sub(least) / step;
            let (size, count) = (most.map(|most| place(most) + 1), number("SLURM_ARRAY_TASK_COUNT")?);
            // Of `--array=1,2,5` nobody would run shares 2 and 3.
            if let (Some(size), Some(count)) = (size, count)
                && size != count
            {
                let message = Diagnostic::error(format!("the array of Slurm has {count} of {size} numbers"));
                return Err(message.hint(ITSELF).into());
            }
            (place(task), size.or(count), "SLURM_ARRAY_TASK_ID")
        } else if let Some(index) = number("JOB_COMPLETION_INDEX")? {
            (index, number("JOB_COMPLETIONS")?, "JOB_COMPLETION_INDEX")
        } else {
            return match shards.unwrap_or(1) {
                1 => Ok(Shard::WHOLE),
                _ => Err(Diagnostic::error("nothing says which of the shards this is").hint(ITSELF).into()),
            };
        };
        // Part of an array, such as 2 to 4 of 10, would number its shares anew and run others than those.
        if let (Some(shards), Some(said)) = (shards, said)
            && shards != said
        {
            let message =
                Diagnostic::error(format!("the scheduler says that there are {said} shards, and `--shards` {shards}"));
            return Err(message.hint(ITSELF).into());
        }
        let of = shards.or(said).ok_or_else(|| {
            let message = Diagnostic::error(format!("{name} is {index}, but nothing says of how many"));
            message.hint("`--shards N` does")
        })?;
        Shard::new(index, of)
            .filter(|_| index < of)
            .ok_or_else(|| Diagnostic::error(format!("{name} is {index}, but there are {of} shards")).into())
    }

    /// True of a recording by its number in the plan.
    pub fn has(self, number: usize) -> bool {
        number as u64 % self.of == self.index
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_recording_is_in_one_shard() {
        for of in [1, 7, 24] {
            for number in 0..100 {
                let shards = (1..=of).map(|index| Shard::parse(&format!("{index}/{of}")).unwrap());
                assert_eq!(shards.filter(|shard| shard.has(number)).count(), 1);
            }
        }
        assert_eq!(Shard::parse("0/7"), Shard::parse("7/7"));
        assert!(["", "1", "8/7", "1/0", "a/2", "-1/2"].iter().all(|text| Shard::parse(text).is_err()));
    }

    #[test]
    fn schedulers_say_which_shard_this_is() {
        let of = |pairs: &[(&str, &str)], shards| {
            let pairs: Vec<(String, String)> =
                pairs.iter().map(|(name, value)| ((*name).into(), (*value).into())).collect();
            Shard::of_environment(
                &|name| pairs.iter().find(|(known, _)| known == name).map(|(_, value)| value.clone()),
                shards,
            )
        };
        assert_eq!(of(&[], None), Ok(Shard::WHOLE));
        let slurm = [("SLURM_ARRAY_TASK_ID", "5"), ("SLURM_ARRAY_TASK_MIN", "1"), ("SLURM_ARRAY_TASK_MAX", "7")];
        assert_eq!(of(&slurm, None), Ok(Shard { index: 4, of: 7 }));
        let job = ("JOB_COMPLETION_INDEX", "3");
        assert_eq!(of(&[job, ("JOB_COMPLETIONS", "4")], None), Ok(Shard { index: 3, of: 4 }));
        assert_eq!(of(&[job], Some(9)), Ok(Shard { index: 3, of: 9 }));
        for (pairs, shards) in
            [(&[job][..], None), (&[job], Some(3)), (&[("JOB_COMPLETION_INDEX", "x")], None), (&[], Some(2))]
        {
            assert!(of(pairs, shards).is_err(), "{pairs:?}");
        }
        assert_eq!(of(&slurm, Some(7)), Ok(Shard { index: 4, of: 7 }));
        // Part of an array, and one with gaps, would run other shares than those that are meant.
        let said = |result: Result<Shard, Report>| result.expect_err("it is refused").render(false);
        assert!(said(of(&slurm, Some(10))).contains("says that there are 7 shards, and `--shards` 10"));
        assert!(said(of(&[job, ("JOB_COMPLETIONS", "4")], Some(9))).contains("says that there are 4 shards"));
        let gaps = [slurm[0], slurm[1], slurm[2], ("SLURM_ARRAY_TASK_COUNT", "3")];
        assert!(said(of(&gaps, None)).contains("the array of Slurm has 3 of 7 numbers"));
    }
}
