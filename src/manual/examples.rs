//! Examples of instructions: a small program each, with what it does beside its lines. Tests run them.

/// Files of examples: blocks that begin with a line `;; name`.
const FILES: &[&str] = &[
    include_str!("examples/scalar.s"),
    include_str!("examples/integer.s"),
    include_str!("examples/vector.s"),
    include_str!("examples/wide.s"),
    include_str!("examples/ray.s"),
    include_str!("examples/packet.s"),
    include_str!("examples/walk.s"),
    include_str!("examples/memory.s"),
    include_str!("examples/control.s"),
];

/// Beginning of the line that names the instruction of a block.
const MARK: &str = ";; ";

/// All examples: the name of an instruction, and its program.
pub fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    let blocks = FILES.iter().flat_map(|text| text.split(MARK).skip(1));
    blocks.filter_map(|block| block.split_once('\n')).map(|(name, program)| (name.trim(), program.trim_end()))
}

/// The example of an instruction; rows of extensions have none.
pub fn find(name: &str) -> Option<&'static str> {
    all().find(|(other, _)| *other == name).map(|(_, program)| program)
}
