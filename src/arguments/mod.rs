//! Groups of options that several commands share, and how values such as `x,y,z` are read.

mod chart;
mod effort;
mod extension;
mod job;
mod kernel;
mod machine;
mod numbers;
pub mod overrides;
mod recordings;
mod tree;
mod value;
mod view;

pub use chart::{ChartArguments, chart_file};
pub use effort::{EffortArguments, SkipArguments};
pub use extension::ExtensionArguments;
pub use job::JobArguments;
pub use kernel::{KernelArguments, KernelFileArguments, plain};
pub use machine::{
    MachineArguments, MachineKeyArguments, SetArguments, SettingsArguments, arbiter, engine, layout, machines,
};
pub use numbers::{ArithmeticArguments, FormatArguments, NumberArguments, OverflowArguments};
pub use recordings::{RecordingArguments, tell_notes};
pub use tree::TreeArguments;
pub use value::{Rectangle, Size, numbered, point, positive, rectangle, setting, size, ungrouped, whole};
pub use view::{CameraArguments, ViewArguments};
