//! Reasons of relaxations that do not converge: the remaining residual, the thin triangle, the lock.

use crate::common::Scene;

/// Claim: if slivers of 4e-5 keep the force from vanishing, the reason is that the residual stays above the tolerance,
/// not that the forces balance, and names the worst triangle. If the solver converges on this sheet some day, there is
/// no reason at all.
#[test]
fn slivers() {
    let mesh = "{\"vertices_coords\": [[0,0],[1,0],[2,0],[0,1],[1,1],[2,1],[0,2],[1,2],[2,2],\
        [1.0000444288968125,1.0000133286690436],[1,1.0000444288968125]],\n\"faces_vertices\": [[0,1,4],[0,4,3],[1,2,9],\
        [1,9,4],[2,5,9],[5,8,9],[8,10,9],[9,10,4],[8,7,10],[7,6,10],[6,3,10],[3,4,10]]}";
    let scene = Scene::on(
        "mesh = \"m.fold\"",
        "[energy]\nbars = { stiffness = 283.496 }\ncreases = { stiffness = 1.0, rest = 0.4 }\n\
         [[study]]\nname = \"a\"\nkind = \"relax\"\nstart = { random = 5e-4, seed = 7 }\n",
    );
    let said = scene.with("m.fold", mesh).program("");
    let (status, said) = (said.status, said.out);
    assert!(!said.contains("the forces balance"), "{said}");
    let named = said.contains("stays above the tolerance") && said.contains("the worst triangle of the sheet is thin");
    assert!(status == Some(0) || named, "{said}");
}

/// Claim: contradictory locks on a vertex of four creases are reported with the lock that is not satisfied, and without
/// residuals that are NaN.
#[test]
fn locks_that_contradict() {
    let lock = |vertex: usize, angle: f64| format!("[[lock]]\ncrease = [0, {vertex}, 0, 0]\nangle = {angle:?}\n");
    let locks = [lock(1, 2.0), lock(2, -2.0), lock(3, 0.5)].concat();
    let energy = "[energy]\nbars = { stiffness = inf }\ncreases = { stiffness = 1.0 }\n";
    let study = "[[study]]\nname = \"a\"\nkind = \"relax\"\n";
    let scene = Scene::on("mesh = \"degree-four.fold\"", &format!("{energy}{locks}{study}"));
    let said = scene.program("").ends(1).out;
    assert!(said.contains("the lock of crease [0, ") && !said.contains("NaN"), "{said}");
}
