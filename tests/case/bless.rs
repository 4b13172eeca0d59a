//! Rewrites the claims of a case so that they say what happened. What they said shows in the change of the file.

use super::Case;
use super::claim::Comment;
use super::verdict::{Difference, Remedy};

/// Column of a comment where there was none.
const COLUMN: usize = 40;

/// The text of a case with its claims made right.
pub fn blessed(case: &Case, differences: &[Difference]) -> String {
    let mut lines: Vec<String> = case.text.lines().map(str::to_owned).collect();
    let mut comments = case.comments.clone();
    // From the last one, so that removing a claim moves no other.
    let mut in_order: Vec<&Difference> = differences.iter().collect();
    in_order.sort_by_key(|difference| std::cmp::Reverse(difference.claim));
    for difference in in_order {
        match (&difference.remedy, difference.claim) {
            (Remedy::Replace(right), Some((comment, at))) => comments[comment].claims[at] = right.clone(),
            (Remedy::Remove, Some((comment, at))) => _ = comments[comment].claims.remove(at),
            (Remedy::Add(claim), _) => match comments.iter_mut().find(|comment| comment.line == difference.line) {
                Some(comment) => comment.claims.push(claim.clone()),
                None if difference.line == 0 => lines.push(format!("; {claim}")),
                None => {
                    let code = lines[difference.line - 1].clone();
                    let (line, claims) = (difference.line, vec![claim.clone()]);
                    comments.push(Comment { line, code, column: COLUMN, claims, prose: None });
                }
            },
            _ => {}
        }
    }
    for comment in &comments {
        lines[comment.line - 1] = line_text(comment);
    }
    lines.iter().map(|line| format!("{}\n", line.trim_end())).collect()
}

fn line_text(comment: &Comment) -> String {
    let claims: Vec<String> = comment.claims.iter().map(ToString::to_string).collect();
    let mut text = claims.join("; ");
    if let Some(prose) = &comment.prose {
        text += &format!(" -- {prose}");
    }
    if text.is_empty() {
        return comment.code.clone();
    }
    let blanks =
        if comment.column == 0 { 0 } else { comment.column.saturating_sub(comment.code.chars().count()).max(1) };
    format!("{}{}; {text}", comment.code, " ".repeat(blanks))
}
