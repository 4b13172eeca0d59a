//! Forms of the rows of the walk unit: their meanings.

use super::{Form, Lower, S, V, W, WalkRoom};
use cranelift_codegen::ir::Value;

impl WalkRoom for Lower<'_, '_> {
    fn rwalk(&mut self, _: S, _: S, _: V, _: W, _: S) -> Form<(Value, Value, Value)> {
        Form::Call
    }
}
