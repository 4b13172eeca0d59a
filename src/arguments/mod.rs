//! Groups of options that several commands share, and how values such as `x,y,z` are read. What the values do is said in
//! [`crate::job`].

mod effort;
mod extension;
mod kernel;
mod machine;
mod numbers;
pub mod overrides;
mod tree;
mod value;
mod view;

pub use effort::EffortArguments;
pub use extension::{ExtensionArguments, extend};
pub use kernel::{KernelArguments, plain};
pub use machine::{MachineArguments, engine, layout};
pub use numbers::NumberArguments;
pub use tree::TreeArguments;
pub use value::{Rectangle, Size, numbered, point, rectangle, setting, size, whole};
pub use view::{CameraKind, ViewArguments};
