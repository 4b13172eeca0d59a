//! Motions by source lines and calls, forwards and back.

use emu::stepper::Executed;

use super::session::{Session, StopReason};

type LineId = Option<(u16, u32)>;

fn line(session: &Session, pc: u32) -> LineId {
    session.target.program.lines.get(pc as usize).map(|line| (line.source, line.line))
}

fn depth(session: &Session) -> usize {
    session.stepper().calls().len()
}

/// On to the next source line, into calls.
pub fn line_step(session: &mut Session) -> StopReason {
    let (pc, from, deep) = (session.pc(), line(session, session.pc()), depth(session));
    session.run(&mut |session, _| session.pc() == pc || line(session, session.pc()) != from || depth(session) != deep)
}

/// On to the next source line, over calls.
pub fn line_next(session: &mut Session) -> StopReason {
    let (pc, from, deep) = (session.pc(), line(session, session.pc()), depth(session));
    session.run(&mut |session, _| {
        let now = depth(session);
        now < deep || now == deep && (session.pc() == pc || line(session, session.pc()) != from)
    })
}

/// On until the function has returned.
pub fn out(session: &mut Session) -> StopReason {
    let deep = depth(session);
    session.run(&mut |session, _| depth(session) < deep)
}

/// True where a line begins: the instruction before was of another one, or came from another function.
fn begins_line(session: &Session, executed: Option<&Executed>) -> bool {
    executed
        .is_none_or(|executed| line(session, executed.pc) != line(session, session.pc()) || executed.pc >= session.pc())
}

/// Back to the beginning of a source line, into calls.
pub fn back_step(session: &mut Session) -> StopReason {
    session.run_back(&mut |session, executed| begins_line(session, executed))
}

/// Back to the beginning of a source line, over calls.
pub fn back_next(session: &mut Session) -> StopReason {
    let deep = depth(session);
    session.run_back(&mut |session, executed| depth(session) <= deep && begins_line(session, executed))
}

/// Back to the call of the function.
pub fn back_out(session: &mut Session) -> StopReason {
    let deep = depth(session);
    session.run_back(&mut |session, _| depth(session) < deep)
}
