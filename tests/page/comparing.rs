//! What is drawn over a loop, and the link that carries the view.

use serde_json::{Value, json};
use stickslip_wire::client::Options;
use stickslip_wire::{CreateRequest, Move, MoveRequest};

use crate::browser::Browser;
use crate::common::create;
use crate::scene::{LIVE, Scene};

/// The points of a line of a plot, in pixels.
async fn line(browser: &Browser, plot: &str, kind: &str) -> Vec<[f64; 2]> {
    let way = format!(
        "document.querySelector('#plot-{plot} .line.{kind}').getAttribute('d').slice(1).split(/[LM]/)\
         .map((p) => p.split(',').map(Number))"
    );
    serde_json::from_value(browser.value(&way).await).unwrap()
}

/// How far a point is from the nearest corner of a line, in pixels.
fn off(point: &[f64; 2], line: &[[f64; 2]]) -> f64 {
    line.iter().map(|place| (place[0] - point[0]).hypot(place[1] - point[1])).fold(f64::INFINITY, f64::min)
}

#[tokio::test]
async fn a_measured_file_and_another_contact_are_drawn_over_the_loop_and_a_link_carries_the_view() {
    let scene = Scene::start().await;
    let (browser, client) = (&scene.browser, &scene.server.client);
    let twin = CreateRequest { label: Some("Its twin".to_owned()), ..create() };
    let twin = client.create(&twin, &Options::default()).await.unwrap();
    for part in [0.9, -0.6, 0.3] {
        scene.moved(&[part]).await;
        let step = Move::displacement(part * scene.ball.contact.gross_slip_displacement);
        client.apply(twin.id, &MoveRequest::from(step), &Options::default()).await.unwrap();
    }
    let states = client.history(scene.ball.id, None, None).await.unwrap().items;
    // The same states as a rig would record them: the time first, in µm and mN, with decimal commas and a gap.
    let row = |index: usize, u: f64, f: f64| format!("{index};{};{}\n", u * 1e6, f * 1e3).replace('.', ",");
    let rows = states
        .iter()
        .enumerate()
        .map(|(index, item)| row(index, item.state.displacement.unwrap(), item.state.force.unwrap()));
    let table = format!("# rig\nTime (s);Displacement (um);Force (mN)\n{}9;;\n", rows.collect::<String>());

    scene.open(&scene.ball, "").await;
    browser.until("document.querySelector('#plot-loop .line.past')?.getAttribute('d').split('L').length > 20").await;
    let drop = format!(
        "(() => {{ const data = new DataTransfer(); data.items.add(new File([{}], 'rig_loop.csv')); \
         document.querySelector('#plot-loop svg').dispatchEvent(new DragEvent('drop', \
         {{ dataTransfer: data, bubbles: true, cancelable: true }})); }})() ?? null",
        json!(table)
    );
    browser.value(&drop).await;
    browser.says("#overlay-said", "3 points of rig_loop.csv.").await;
    browser.find("#plot-loop .line.file").await;
    let (past, file) = (line(browser, "loop", "past").await, line(browser, "loop", "file").await);
    assert_eq!(file.len(), 3);
    for point in &file {
        assert!(off(point, &past) < 0.1, "{point:?} is not on the path that it was read from");
    }
    // In another unit it is elsewhere.
    browser.set("[aria-label='Unit of measured force']", "0").await;
    browser.counts("#plot-loop .level line", 2).await;
    let wide = "[...document.querySelectorAll('#plot-loop .grid text')].some((text) => Number(text.textContent) >= 1)";
    browser.until(wide).await;
    browser.click("#overlay button").await;
    browser.counts("#plot-loop .line.file", 0).await;

    // The twin has the same loop and the same stress, until it is moved.
    browser.unfold("#overlay").await;
    browser.counts("#compare option", 2).await;
    browser.set("#compare", &twin.id.to_string()).await;
    browser.find("#plot-loop .line.other").await;
    browser.find("#plot-stress .line.other").await;
    browser.until(&format!("location.hash.includes('with={}')", twin.id)).await;
    let (past, twins) = (line(browser, "loop", "past").await, line(browser, "loop", "other").await);
    for end in [&twins[0], twins.last().unwrap()] {
        assert!(off(end, &[past[0], *past.last().unwrap()]) < 0.1, "{end:?}");
    }
    let (tau, twins_tau) = (line(browser, "stress", "tau").await, line(browser, "stress", "other").await);
    assert!(twins_tau.iter().all(|point| off(point, &tau) < 0.1));
    browser.picture("compared").await;
    let gone = Move::displacement(-0.9 * scene.ball.contact.gross_slip_displacement);
    client.apply(twin.id, &MoveRequest::from(gone), &Options::default()).await.unwrap();
    let last =
        "Number(document.querySelector('#plot-loop .line.other').getAttribute('d').split('L').at(-1).split(',')[0])";
    browser.until(&format!("{last} < {}", past.last().unwrap()[0] - 20.0)).await;

    // Zoom, a line switched off, a unit, and the contact compared with are in the address.
    browser.drag("#plot-loop svg", 0.4, 0.7).await;
    browser.click("#plot-loop .key.past").await;
    browser.set("#unit-displacement", "-6").await;
    let ticks = "[...document.querySelectorAll('#plot-loop .grid text')].map((text) => text.textContent).join()";
    browser.counts("#plot-loop .line.past", 0).await;
    let zoomed = browser.value(ticks).await;
    let link = browser.value("location.href").await.as_str().unwrap().to_owned();
    scene.view("").await;
    browser.find(".list").await;
    browser.page.goto(&link).await.unwrap();
    browser.until(LIVE).await;
    browser.find("#plot-loop .line.other").await;
    browser.until(&format!("{ticks} === {zoomed}")).await;
    assert_eq!(browser.value("document.querySelector('#plot-loop .line.past')").await, Value::Null);
    assert_eq!(browser.value("document.querySelector('#unit-displacement').value").await, "-6");
    assert_eq!(browser.value("document.querySelector('#plot-loop .key.past').ariaPressed").await, "false");
    // By keyboard the whole plot is shown again, and the address says so.
    browser.press("#plot-loop svg", "0").await;
    browser.until("!location.hash.includes('loop=') && location.hash.includes('loop-off=')").await;
    browser.look(400, 850, true).await;
    browser.until("document.documentElement.scrollWidth <= innerWidth").await;
    scene.end(&[]).await;
}
