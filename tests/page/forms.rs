//! The form of a new contact, and what is wrong in forms.

use serde_json::{Value, json};

use crate::hertz;
use crate::scene::{NOT_A_NUMBER, Scene};

const CARD: &str = "form .card:first-child input";
/// The boxes of the form that take numbers, and what is said to be wrong in them.
const BOXES: &str = "[...document.querySelectorAll('form.create .field input[inputmode=decimal]')]";
const FAULTS: &str = ".map((box) => box.closest('.field').querySelector('.fault').innerText)";

#[tokio::test]
async fn a_contact_follows_while_one_types_and_all_faults_are_shown_at_once_in_words() {
    let scene = Scene::start().await;
    let browser = &scene.browser;
    scene.view("new").await;
    browser.says(".derived", &hertz(10.0, 0.01, 2.0)).await;
    browser.write(CARD, "20").await;
    browser.says(".derived", &hertz(10.0, 0.02, 2.0)).await;
    browser.picture("new").await;
    // Radius, Young's modulus and Poisson's ratio of both bodies, friction and load.
    let write = async |texts: [&str; 7]| {
        let all = format!(
            "{BOXES}.map((box, index) => {{ box.value = {}[index]; \
             box.dispatchEvent(new Event('input', {{ bubbles: true }})); }}).length",
            json!(texts)
        );
        assert_eq!(browser.value(&all).await, 7);
    };
    // Every field asks what a comma before three digits separates; which texts those are, `pure.test.js` has.
    let question = "Write 1.000 or 1000: 1,000 may be either.";
    write(["1,000"; 7]).await;
    browser.until(&format!("{BOXES}{FAULTS}.every((fault) => fault === {question:?})")).await;
    browser.click("#create").await;
    write(["10 mm", "210", "0,300", "210", "0,300", "-0.3", ""]).await;
    browser.click("#create").await;
    let expected = |index: usize, fault: &str| format!("{BOXES}{FAULTS}[{index}].includes({fault:?})");
    for (index, fault) in [(0, NOT_A_NUMBER), (5, "out of range"), (6, "A number is missing here.")] {
        browser.until(&expected(index, fault)).await;
    }
    browser.picture("faults").await;
    assert_eq!(scene.server.client.contacts(None, None).await.unwrap().items.len(), 1, "the form waits for answers");
    // These are one number each: thousands have three digits in a group, and no group begins with 0.
    write(["12,5", "210", "0,300", "210", "0,300", "0,3", "1000,000e-2"]).await;
    browser.says(".derived", &hertz(10.0, 0.0125, 2.0)).await;
    browser.until(&format!("{BOXES}{FAULTS}.join('') === ''")).await;

    // Other boxes ask too, and none is read by the language of the browser.
    scene.moved(&[0.9, -0.7]).await;
    for (tab, field, act, said) in
        [("/residual", "#reversals", "#run", "#run-status"), ("", "#back-to", "#go-back", "#notice")]
    {
        scene.open(&scene.ball, tab).await;
        browser.write(field, "1,000").await;
        browser.click(act).await;
        browser.says(said, "1,000 may be either.").await;
        browser.counts("input[type=number]", 0).await;
    }
    // A path says its work, or its fault; it is run whole or not at all.
    let field = "#path-card textarea";
    for (path, fault) in [(r#"{"cycles": {"displacement": 1e-7, "count": 0}}"#, "cycles/count"), ("up", "not JSON")] {
        browser.write(field, path).await;
        browser.click("#compute-path").await;
        browser.says("#path-card .fault", fault).await;
    }
    assert_eq!(scene.now().await.0, 2);
    browser.write(field, r#"{"cycles": {"displacement": 1e-7, "count": 5}}"#).await;
    browser.click("#compute-path").await;
    browser.says("#path-status", "Done. Friction work of the path: ").await;
    // Five cycles with the two moves of each, and the first to a turn.
    let (sequence, state) = scene.now().await;
    assert_eq!((sequence, state.displacement), (13, Some(1e-7)));
    scene.end(&["status of 422"]).await;
}

#[tokio::test]
async fn every_shape_body_and_preload_can_be_chosen() {
    let scene = Scene::start().await;
    let browser = &scene.browser;
    let client = &scene.server.client;
    scene.view("new").await;
    browser.find("form select").await;
    let types = browser.value("[...document.querySelector('form select').options].map((option) => option.value)").await;
    let types: Vec<String> = serde_json::from_value(types).unwrap();
    let document = client.openapi().await.unwrap();
    assert_eq!(types.len(), document["components"]["schemas"]["Profile"]["oneOf"].as_array().unwrap().len());
    let shapes = types.iter().map(|kind| ("Shape of the indenter", kind.as_str(), "/profile/type", json!(kind)));
    let bodies = [
        ("Elasticity", "rigid", "/material/bodies/1", json!("rigid")),
        ("Elasticity", "effective", "/material/effective/e_star", json!(1.15e11)),
        ("Preload by", "indentation", "/preload/indentation", json!(1e-6)),
        ("Preload by", "contact_radius", "/preload/contact_radius", json!(1e-4)),
    ];
    for (label, value, pointer, expected) in shapes.chain(bodies) {
        browser.value("location.assign('#/new') ?? null").await;
        browser.find("#create").await;
        browser.choose(label, value).await;
        if value == "tabulated" {
            browser.write("form textarea", "# µm\n0;0\n100;0,5\n200;2,0\n300;4,5").await;
        }
        browser.click("#create").await;
        let id = scene.shown(None).await;
        let made: Value = serde_json::to_value(client.definition(id).await.unwrap()).unwrap();
        assert_eq!(made.pointer(pointer), Some(&expected), "{value}");
        if value == "ellipsoid" {
            assert_eq!(made["profile"], json!({"type": "ellipsoid", "radii": [0.01, 0.005], "direction": "x"}));
        }
        if value == "tabulated" {
            assert_eq!(made["profile"]["r"], json!([0.0, 1e-4, 2e-4, 3e-4]));
            assert_eq!(made["profile"]["z"], json!([0.0, 5e-7, 2e-6, 4.5e-6]));
        }
    }
    // A table that is not whole yet is refused, and the browser itself says so.
    scene.end(&["status of 422"]).await;
}
