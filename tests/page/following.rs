//! Results that follow the state of a contact: the steady cycle, the mark of a map, and the stress below the surface.

use std::f64::consts::PI;

use serde_json::json;
use stickslip_wire::client::Options;
use stickslip_wire::{Move, NewSession};

use crate::axe;
use crate::browser::words;
use crate::common::{create, until};
use crate::scene::Scene;
use crate::{four, pascals};

/// The bodies apart.
const APART: Move = Move {
    indentation: Some(-1e-9),
    displacement: Some(1e-8),
    force: None,
    normal_force: None,
    duration: None,
    twist: None,
    torque: None,
    relative: false,
};

/// Friction work of a steady cycle of the ball, J, whose amplitude is this part of the displacement of gross slip
/// (Mindlin & Deresiewicz 1953).
fn work_of_cycle(session: &NewSession, part: f64) -> f64 {
    let left = 1.0 - part;
    let area = part - 0.4 * (1.0 - left.powf(2.5)) - 0.5 * (1.0 - left.powf(1.5)) * part;
    8.0 * area * session.contact.gross_slip_force * session.contact.gross_slip_displacement
}

#[tokio::test]
async fn the_steady_cycle_and_the_mark_of_the_map_follow_the_contact() {
    let scene = Scene::start().await;
    let (browser, ball) = (&scene.browser, &scene.ball);
    scene.open(ball, "/damping").await;
    let card = "#steady-card";
    browser.says(card, "Pull the displacement").await;
    browser.click("#compute-map").await;
    let bound = "document.querySelector('#plot-map .line.bound')";
    browser.until(&format!("{bound} !== null && document.querySelector('#plot-map .mark') === null")).await;
    for part in [0.5, -0.9] {
        scene.moved(&[part]).await;
        browser.says(card, &format!("{} nJ", four(1e9 * work_of_cycle(ball, part.abs())))).await;
        browser.says(card, "inside, the surfaces stick").await;
    }
    // F over U, the force that of a first loading.
    let (force, displacement) = (ball.contact.gross_slip_force, ball.contact.gross_slip_displacement);
    let stiffness = four(1e-6 * (1.0 - 0.1_f64.powf(1.5)) * force / (0.9 * displacement));
    browser.says(card, &format!("{stiffness} MN/m")).await;
    // Dragged to the end and back to the middle, it ends with what belongs there.
    browser.drag("#slide-displacement", 0.2, 0.99).await;
    browser.says(card, "slides in each stroke").await;
    scene.moved(&[0.5]).await;
    browser.says(card, "inside, the surfaces stick").await;

    // The amplitude that does 100 nJ a cycle, by bisection.
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if work_of_cycle(ball, middle) < 1e-7 { &mut low } else { &mut high }) = middle;
    }
    let contour = "[...document.querySelectorAll('#plot-map text.small')].find((text) => text.textContent === '100 \
        nJ').previousSibling";
    for (part, line) in [(1.0, bound), (low, contour)] {
        scene.moved(&[part]).await;
        // The height of the line at the mark, which must be within the map.
        let off = format!(
            "(() => {{ const mark = document.querySelector('#plot-map .mark'); if (!mark) return false; \
             const [x, y] = ['cx', 'cy'].map((name) => Number(mark.getAttribute(name))); \
             const way = {line}.getAttribute('d').slice(1).split('L').map((p) => p.split(',').map(Number)); \
             const next = way.findIndex((p) => p[0] >= x); if (next < 1) return false; \
             const [from, to] = [way[next - 1], way[next]]; \
             const there = from[1] + ((to[1] - from[1]) * (x - from[0])) / (to[0] - from[0]); \
             return Math.abs(there - y) < 1; }})()"
        );
        browser.until(&off).await;
    }
    axe::assert_readable(browser, "map").await;
    scene.moved(&[0.0]).await;
    browser.until(&format!("{0}.includes('Pull') && !{0}.includes('J')", words(card))).await;
    scene.apply(APART).await;
    browser.until(&format!("{0}.includes('Without a load') && !{0}.includes('J')", words(card))).await;
    scene.end(&[]).await;
}

/// Hertz's stress on the axis at a depth in contact radii, Pa: von Mises and the mean, under this Poisson's ratio.
fn below(session: &NewSession, poisson: f64, depth: f64) -> (f64, f64) {
    let most = 3.0 * 10.0 / (2.0 * PI * session.contact.contact_radius.powi(2));
    let axial = -1.0 / (1.0 + depth * depth);
    let radial = -(1.0 + poisson) * (1.0 - depth * (1.0 / depth).atan()) - 0.5 * axial;
    (most * (axial - radial).abs(), most * (axial + 2.0 * radial) / 3.0)
}

impl Scene {
    /// The largest von Mises stress of the section that the page shows, as the service has it now.
    async fn largest(&self) -> String {
        let a = self.now().await.1.contact_radius;
        let plane = json!({"normal": "y", "offset": 0.0, "x": [-2.0 * a, 2.0 * a, 61], "z": [0.0, 1.5 * a, 31]});
        let request = json!({"body": "first", "plane": plane, "fields": ["von_mises"]});
        let request = serde_json::from_value(request).unwrap();
        let reply = self.server.client.subsurface(self.ball.id, &request).await.unwrap();
        pascals(reply.stress.von_mises.unwrap().into_iter().flatten().fold(0.0, f64::max), 3)
    }
}

#[tokio::test]
async fn the_stress_below_the_surface_follows_the_moves() {
    let scene = Scene::start().await;
    let (browser, ball) = (&scene.browser, &scene.ball);
    scene.open(ball, "/crack").await;
    let text = "#below-text";
    // Of the rows of the section, the one at 0.5 a is nearest to Hertz's depth of 0.48 a.
    let (mises, _) = below(ball, 0.3, 0.5);
    let depth = format!("{:.1} µm below the surface at x = 0.", 0.5e6 * ball.contact.contact_radius);
    browser.says(text, &format!("Largest von Mises stress {}, {depth}", pascals(mises, 3))).await;
    let bodies = "[...document.querySelector('#below-card select').options].map((option) => option.value).join()";
    assert_eq!(browser.value(bodies).await, "first", "a rigid body has no stress");
    browser.counts("#below-card input", 0).await;
    browser.choose("Stress", "max_shear").await;
    browser.says(text, &format!("Largest shear stress on any plane {}, {depth}", pascals(0.5 * mises, 3))).await;
    browser.choose("Stress", "hydrostatic").await;
    let (_, mean) = below(ball, 0.3, 1e-9);
    browser.says(text, &format!("Largest mean compression {}, on the surface at x = 0.", pascals(-mean, 3))).await;
    browser.choose("Stress", "von_mises").await;
    browser.says(text, &pascals(mises, 3)).await;

    // It follows moves by another client and the slider, and ends with what belongs to the last of them.
    scene.moved(&[0.9, -0.7]).await;
    browser.says(text, &scene.largest().await).await;
    browser.drag("#slide-displacement", 0.3, 0.95).await;
    scene.moved(&[1.5]).await;
    let sliding = scene.largest().await;
    browser.says(text, &sliding).await;
    assert_ne!(sliding, pascals(mises, 3), "friction adds to it");
    // By keyboard, from the upper left corner to the right.
    browser.press("#plot-below svg", "\u{e011}\u{e014}").await;
    let corner = browser.value("document.querySelector('#plot-below .said').textContent").await;
    let corner = corner.as_str().unwrap();
    assert!(
        corner.contains("Depth z 0 m, von Mises stress") && corner.starts_with("x, along the motion −"),
        "{corner}"
    );
    scene.apply(APART).await;
    browser.says(text, "do not press").await;
    browser.until("document.querySelector('#plot-below').hidden").await;
    scene.end(&[]).await;
}

#[tokio::test]
async fn below_the_surface_reduced_moduli_need_a_poissons_ratio_and_an_edge_is_infinite() {
    let scene = Scene::start().await;
    let browser = &scene.browser;
    let mut request = create();
    let material = json!({"effective": {"e_star": 2.31e11, "g_star": 1.9e11}});
    request.material = serde_json::from_value(material).unwrap();
    let session = scene.server.client.create(&request, &Options::default()).await.unwrap();
    request.profile = serde_json::from_value(json!({"type": "flat_punch", "radius": 1e-4})).unwrap();
    let punch = scene.server.client.create(&request, &Options::default()).await.unwrap();
    browser.look(400, 850, true).await;
    scene.open(&session, "/crack").await;
    let (text, input) = ("#below-text", "#below-card input");
    for (typed, poisson) in [("0.3", 0.3), ("0", 0.0), ("0,5", 0.5)] {
        browser.write(input, typed).await;
        browser.choose("Stress", "hydrostatic").await;
        browser.says(text, &pascals(-below(&session, poisson, 1e-9).1, 3)).await;
    }
    browser.choose("Stress", "von_mises").await;
    browser.set("#below-card select", "second").await;
    browser.says(text, &pascals(below(&session, 0.5, 0.55).0, 3)).await;
    browser.until("document.documentElement.scrollWidth <= innerWidth").await;
    browser.write(input, "0.7").await;
    let fault = "[...document.querySelectorAll('#below-card .fault')].map((fault) => fault.innerText).join('')";
    browser.until(&format!("{fault}.includes('0.5') && document.querySelector('#plot-below').hidden")).await;
    browser.write(input, "0.5").await;
    browser.until(&format!("{fault} === '' && !document.querySelector('#plot-below').hidden")).await;
    // On a phone a slider sends one move, too.
    browser.drag("#slide-displacement", 0.5, 0.9).await;
    let sequence = async || scene.server.client.contact(session.id).await.unwrap().sequence;
    until("the slider moves the contact", async || (sequence().await == 1).then_some(())).await;
    scene.open(&punch, "/crack").await;
    browser.says(text, "Infinite on the surface at x = −100 µm, where").await;
    scene.end(&["status of 422"]).await;
}
