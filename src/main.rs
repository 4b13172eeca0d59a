//! Command line of lancer.

fn main() {}
