//! Forms of the rows of the packet unit: their meanings, compiled for the vectors of the host.

use super::{Form, Lower, PacketRoom, S, V};
use cranelift_codegen::ir::Value;

impl PacketRoom for Lower<'_, '_> {
    fn rnear(&mut self, _: V, _: V, _: S, _: S, _: i32) -> Form<(Value,)> {
        Form::Call
    }

    fn rany(&mut self, _: V, _: V, _: S, _: S, _: i32) -> Form<(Value,)> {
        Form::Call
    }
}
