//! Flame graph of stacks, as a figure that the chart of flames draws.

use super::stacks::ClockStack;
use crate::chart::{FlameFigure, FlameKind, FlameNode};
use crate::numeral::{grouped, percent};

/// The flame graph of stacks. What was waited for stands on top of who waited; of what stands side by side the longest comes first.
pub fn flame(title: String, stacks: &[ClockStack]) -> FlameFigure {
    let mut root = FlameNode::new("all cores", FlameKind::Work);
    for stack in stacks {
        let last = stack.names().len() - 1;
        let mut node = &mut root;
        node.weight += stack.clocks;
        for (depth, name) in stack.names().into_iter().enumerate() {
            let is_wait = stack.waits_for.is_some() && depth == last;
            let kind = if is_wait { FlameKind::Wait } else { FlameKind::Work };
            let at = node.children.iter().position(|child| child.name == name).unwrap_or_else(|| {
                node.children.push(FlameNode::new(&name, kind));
                node.children.len() - 1
            });
            node = &mut node.children[at];
            node.weight += stack.clocks;
        }
    }
    let all = root.weight;
    finish(&mut root, all);
    FlameFigure {
        title,
        note: "Clocks of all cores by stack of functions: as wide as they are long. Orange: computing in it or in what it calls; \
               blue: waiting for the bus."
            .to_owned(),
        root,
    }
}

/// Puts what stands side by side in order, and says what each took.
fn finish(node: &mut FlameNode, all: u64) {
    node.children.sort_by(|one, other| other.weight.cmp(&one.weight).then_with(|| one.name.cmp(&other.name)));
    node.tip = format!("{}: {} clocks, {}", node.name, grouped(node.weight), percent(node.weight, all));
    node.children.iter_mut().for_each(|child| finish(child, all));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_comes_first_and_waits_stand_on_top() {
        let stack = |frames: &[&str], waits_for: Option<&str>, clocks| ClockStack {
            frames: frames.iter().map(|&name| name.to_owned()).collect(),
            waits_for: waits_for.map(str::to_owned),
            clocks,
        };
        let stacks = [
            stack(&["a"], None, 1),
            stack(&["a", "b"], None, 2),
            stack(&["a", "c"], None, 3),
            stack(&["a", "c"], Some("nodes"), 4),
        ];
        let figure = flame(String::new(), &stacks);
        let a = &figure.root.children[0];
        assert_eq!((figure.root.weight, a.weight), (10, 10));
        let names: Vec<(&str, u64)> = a.children.iter().map(|child| (child.name.as_str(), child.weight)).collect();
        assert_eq!(names, [("c", 7), ("b", 2)]);
        let wait = &a.children[0].children[0];
        assert_eq!((wait.name.as_str(), wait.kind), ("(waits for nodes)", FlameKind::Wait));
        assert_eq!(wait.tip, "(waits for nodes): 4 clocks, 40.0 %");
    }
}
