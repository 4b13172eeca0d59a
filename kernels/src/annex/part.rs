//! Lines of Annex II: a row is made of operations by class, of operations on vectors, and of calls of other rows. Which of them a word of the
//! kernels belongs to is told by where its source line stands.

use isa::Class;

use super::world;

/// An operation on vectors that Annex II has a line for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum VectorOperation {
    /// Sum of two vectors.
    Add,
    /// Difference of two vectors.
    Sub,
    /// Dot product.
    Dot,
    /// Product of a vector with a number.
    Scale,
}

impl VectorOperation {
    /// All of them, in the order in which Annex II prints them.
    pub const ALL: [VectorOperation; 4] =
        [VectorOperation::Add, VectorOperation::Sub, VectorOperation::Dot, VectorOperation::Scale];

    /// Name in results.
    pub const fn name(self) -> &'static str {
        match self {
            VectorOperation::Add => "vector_add",
            VectorOperation::Sub => "vector_sub",
            VectorOperation::Dot => "dot",
            VectorOperation::Scale => "scale",
        }
    }

    /// The label as printed.
    pub const fn label(self) -> &'static str {
        match self {
            VectorOperation::Add => "Addition vecteurs",
            VectorOperation::Sub => "Soustraction vecteurs",
            VectorOperation::Dot => "Produit Scalaire",
            VectorOperation::Scale => "Produit Scalaire x Vecteur",
        }
    }

    /// Elementary operations of one.
    pub const fn operations(self) -> u64 {
        match self {
            VectorOperation::Dot => 5,
            _ => 3,
        }
    }

    /// The macro of `scalar.inc` that stands for it.
    const fn macro_name(self) -> &'static str {
        match self {
            VectorOperation::Add => "add_vectors",
            VectorOperation::Sub => "subtract",
            VectorOperation::Dot => "dot_product",
            VectorOperation::Scale => "scale_vector",
        }
    }

    /// The operation whose macro a line stands in: `file` as programs name it, lines from 1 on.
    pub fn at(file: &str, line: u32) -> Option<VectorOperation> {
        let (path, text) = world::file(SCALAR)?;
        if file.strip_prefix("kernels/asm/") != Some(path) {
            return None;
        }
        VectorOperation::ALL.into_iter().find(|operation| {
            let head = format!(".macro {} ", operation.macro_name());
            let start = text.lines().position(|line| line.starts_with(&head));
            let length = |start| text.lines().skip(start).position(|line| line == ".endm");
            start.zip(start.and_then(length)).is_some_and(|(start, length)| {
                // The head's line counts from 0 here, so the body's first line is two further on.
                (start as u32 + 2..=start as u32 + length as u32).contains(&line)
            })
        })
    }
}

/// The file of the macros.
const SCALAR: &str = "scalar.inc";

/// Kind of a line of a row.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum PartKind {
    /// Operations on vectors.
    Vector(VectorOperation),
    /// Operations of a class.
    Class(Class),
    /// Calls of another row, by its name.
    Row(String),
}

impl PartKind {
    /// The kind of a name: of an operation on vectors, of a class, or of a row.
    pub fn named(name: &str) -> Option<PartKind> {
        let vector = VectorOperation::ALL.into_iter().find(|operation| operation.name() == name);
        let row = || name.contains('.').then(|| PartKind::Row(name.to_owned()));
        vector.map(PartKind::Vector).or_else(|| Class::from_name(name).map(PartKind::Class)).or_else(row)
    }

    /// Name in results.
    pub fn name(&self) -> &str {
        match self {
            PartKind::Vector(operation) => operation.name(),
            PartKind::Class(class) => class.name(),
            PartKind::Row(id) => id,
        }
    }

    /// The label as printed; a class that no annex prints has its name.
    pub fn label(&self) -> &str {
        match self {
            PartKind::Vector(operation) => operation.label(),
            PartKind::Class(Class::Add) => "Addition",
            PartKind::Class(Class::Sub) => "Soustraction",
            PartKind::Class(Class::Mul) => "Multiplication",
            PartKind::Class(Class::Div) => "Division",
            PartKind::Class(Class::Cmp) => "Comparaison",
            PartKind::Class(Class::Mem) => "Accès Mémoire",
            PartKind::Class(other) => other.name(),
            PartKind::Row(id) => super::rows().iter().find(|row| row.id == *id).map_or(id, |row| &row.label),
        }
    }
}

/// A line of a row, as it is printed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PrintedPart {
    /// Kind of the line.
    pub kind: PartKind,
    /// Operations of one.
    pub each: u64,
    /// Number of them.
    pub times: u64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::annex::rows;

    #[test]
    fn a_line_of_a_macro_belongs_to_its_operation() {
        let (_, text) = world::file(SCALAR).unwrap();
        let found = |piece: &str| {
            let line = text.lines().position(|line| line.contains(piece)).unwrap() as u32 + 1;
            VectorOperation::at("kernels/asm/scalar.inc", line)
        };
        assert_eq!(found("add   s17, s17, s18"), Some(VectorOperation::Add));
        assert_eq!(found("sub   s17, s17, s18"), Some(VectorOperation::Sub));
        assert_eq!(found("mul   s17, s17, \\s, "), Some(VectorOperation::Scale));
        assert_eq!(found("add   s12, s12, s17"), Some(VectorOperation::Dot));
        assert_eq!(found(".macro add_vectors"), None);
        assert_eq!(found("sub   s12, s12, s17"), None, "a cross product is no line of the annexes");
        assert_eq!(VectorOperation::at("kernels/asm/surface.inc", 8), None);
    }

    /// Lines add up to the printed total, and calls of rows to theirs; the last row counts a ray tree one too low.
    #[test]
    fn printed_lines_add_up() {
        for row in rows() {
            let sum: u64 = row
                .parts
                .iter()
                .filter(|part| part.kind != PartKind::Class(Class::Mem))
                .map(|part| part.each * part.times)
                .sum();
            let slip = if row.id == "rt.pixel" { 22 } else { 0 };
            assert_eq!(sum + slip, row.printed.elementary(), "{}", row.id);
            for part in &row.parts {
                let each = match &part.kind {
                    PartKind::Vector(operation) => operation.operations(),
                    PartKind::Class(_) => 1,
                    PartKind::Row(id) => {
                        let other = rows().iter().find(|other| other.id == *id).expect("the row is there");
                        other.printed.elementary() - u64::from(row.id == "rt.pixel" && id == "rt.ray_tree")
                    }
                };
                assert_eq!(part.each, each, "{}, {}", row.id, part.kind.name());
            }
        }
    }
}
