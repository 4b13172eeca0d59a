//! Statements of OBJ that have no counterpart in a scene: which they are, and what is said about each kind.

use messages::{Diagnostic, nearest, question};

use super::super::words::{Word, Words, counted, shortened};

/// Losses for one reason.
struct LostKind {
    keywords: &'static [&'static str],
    /// The thing that is counted, as the subject of a sentence; its plural; and the rest of the sentence.
    says: [&'static str; 3],
}

const LOST_KINDS: [LostKind; 7] = [
    LostKind {
        keywords: &["vn", "s"],
        says: ["normal or smoothing group is", "normals and smoothing groups are", "not used: triangles are flat"],
    },
    LostKind { keywords: &["vt"], says: ["texture position is", "texture positions are", "not used"] },
    LostKind { keywords: &["p", "l"], says: ["point or line", "points and lines", "cannot be seen"] },
    LostKind {
        keywords: &[
            "vp", "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv", "sp",
            "end", "con", "bsp", "bzp", "cdc", "cdp", "res",
        ],
        says: ["statement of a curved shape is", "statements of curved shapes are", "not read: only faces are"],
    },
    LostKind {
        keywords: &[
            "bevel",
            "c_interp",
            "d_interp",
            "lod",
            "maplib",
            "usemap",
            "shadow_obj",
            "trace_obj",
            "ctech",
            "stech",
            "mg",
        ],
        says: ["statement about display is", "statements about display are", "not used"],
    },
    LostKind { keywords: &[], says: ["vertex has a colour,", "vertices have colours,", "which are not used"] },
    LostKind {
        keywords: &[],
        says: ["vertex has a weight,", "vertices have weights,", "which are not used: they are for curved shapes"],
    },
];

/// Number of the kind of vertex colours.
pub(super) const COLOURS: usize = 5;

/// Number of the kind of vertex weights.
pub(super) const WEIGHTS: usize = 6;

/// Statements that are used or say nothing about the picture.
const USED: [&str; 9] = ["v", "f", "fo", "usemtl", "mtllib", "o", "g", "call", "csh"];

/// Losses of a file.
#[derive(Default)]
pub(super) struct LostStatements<'a> {
    counts: [usize; LOST_KINDS.len()],
    unknown: Option<Word<'a>>,
    more_unknown: usize,
}

impl<'a> LostStatements<'a> {
    /// Notes one loss of a kind.
    pub(super) fn note(&mut self, kind: usize) {
        self.counts[kind] += 1;
    }

    /// Notes a statement that is not used.
    pub(super) fn statement(&mut self, keyword: Word<'a>, arguments: &[Word<'a>]) {
        let is_off = keyword.text == "s" && arguments.first().is_some_and(|word| ["off", "0"].contains(&word.text));
        match LOST_KINDS.iter().position(|kind| kind.keywords.contains(&keyword.text)) {
            Some(_) if is_off => {}
            Some(kind) => self.note(kind),
            None if USED.contains(&keyword.text) => {}
            None if self.unknown.is_none() => self.unknown = Some(keyword),
            None => self.more_unknown += 1,
        }
    }

    /// Says what is lost. Text that has nothing of an OBJ file, not even a vertex, is an error.
    pub(super) fn complain(self, words: &mut Words<'_>, name: &str, is_empty: bool) {
        for (kind, count) in LOST_KINDS.iter().zip(self.counts).filter(|(_, count)| *count > 0) {
            let [one, many, rest] = kind.says;
            words.complain(Diagnostic::warning(format!("{name}: {} {rest}", counted(count, one, many))));
        }
        let Some(unknown) = self.unknown else { return };
        let place = words.place(unknown.span());
        let text = shortened(unknown.text);
        if is_empty {
            let error = Diagnostic::error(format!("`{text}` is no statement of an OBJ file, and it has no vertices"));
            words.complain(error.at(place, "not known").hint("its lines start with `v`, `f`, `usemtl`, ..."));
            return;
        }
        let mut message = format!("`{text}` is no statement of an OBJ file, and not read");
        if self.more_unknown > 0 {
            let more = counted(self.more_unknown, "other statement is", "other statements are");
            message.push_str(&format!("; {more} not known either"));
        }
        let warning = Diagnostic::warning(message).at(place, "not known");
        let known = USED.iter().chain(LOST_KINDS.iter().flat_map(|kind| kind.keywords)).copied();
        // A letter too many is more likely a statement of some program's own than a slip.
        let near = nearest(&text, known).filter(|near| near.len() > 1);
        words.complain(match near {
            Some(near) => warning.hint(question(near)),
            None => warning,
        });
    }
}
