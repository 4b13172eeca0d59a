//! Sweeps: a study file says which settings vary, a plan lists the points, each with a hash of all that its result depends on; points that share
//! a recording are run together; parts are merged to one table. What is printed and drawn of it is said in the files below.

#[cfg(feature = "cli")]
mod chart;
pub mod contents;
pub mod dataset;
mod digest;
pub mod frames;
pub mod front;
pub mod group;
pub mod identity;
pub mod key_set;
mod latin;
pub mod merge;
#[cfg(feature = "full")]
mod parquet;
pub mod part;
pub mod plan;
pub mod recordings;
pub mod row;
pub mod shard;
pub mod study;
pub mod study_text;

#[cfg(feature = "cli")]
pub use chart::svg;

/// Version of a plan's first line.
pub const PLAN: &str = "lancer-plan-1";

/// Version of a part's first line.
pub const PART: &str = "lancer-part-1";
