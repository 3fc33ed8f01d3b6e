//! Every computation, by its facts: over HTTP and on the command line it replies what the library computes, in every
//! format that it has, and stores nothing.

use reqwest::Method;
use serde_json::{Value, json};
use stickslip_compute::Flag;
use stickslip_compute::computations::{DisplayOptions, compute, entries};
use stickslip_compute::formats::Format;

use crate::common::openapi::{document, examples};
use crate::common::tables::same_numbers;
use crate::common::{Server, problem, run, timeless};

#[tokio::test]
async fn every_computation_replies_what_the_library_computes_in_every_format() {
    let (server, document) = (Server::start().await, document());
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("body.json");
    for about in entries().into_iter().map(|entry| entry.about) {
        let Some(route) = about.route else { continue };
        let has_formats = about.formats.len() > 1;
        for example in examples(&document, &document["paths"][route.path]["post"]) {
            let text = example.to_string();
            std::fs::write(&file, &text).unwrap();
            // Where there are several criteria, a picture shows one that is named.
            let choice = about.choice.and_then(|choice| {
                let word = choice.words.iter().find(|word| example["criteria"].get(**word).is_some())?;
                Some((choice.name, *word))
            });
            let mut written = Vec::new();
            for format in about.formats {
                let shown =
                    DisplayOptions { choice: choice.map(|(_, word)| word), ..DisplayOptions::in_format(*format) };
                let library = compute(about.name, text.as_bytes(), shown, &Flag::default()).unwrap();
                let named = choice.map_or_else(String::new, |(name, word)| format!("&{name}={word}"));
                let query = if has_formats { format!("?format={}{named}", format.name()) } else { String::new() };
                let response = server.post(&format!("{}{query}", route.path), &example).await;
                assert_eq!(response.status(), 200, "{} {query}", route.path);
                assert_eq!(response.headers()["content-type"], format.media_type());
                let served = response.bytes().await.unwrap().to_vec();
                let document = |bytes: &[u8]| timeless(serde_json::from_slice(bytes).unwrap());
                let flag = choice.map(|(name, word)| [format!("--{name}"), word.to_owned()]);
                let mut arguments = vec![about.name, file.to_str().unwrap(), "--format", format.name()];
                arguments.extend(flag.iter().flatten().map(String::as_str));
                let printed = matches!(format, Format::Columns | Format::Csv).then(|| run(&arguments).stdout);
                if *format == Format::Columns {
                    assert_eq!(document(&served), document(&library), "{}", about.name);
                    assert_eq!(document(&printed.unwrap()), document(&library), "{}", about.name);
                } else {
                    assert!(served == library, "{} as {}", about.name, format.name());
                    assert!(printed.is_none_or(|printed| printed == library), "{} as {}", about.name, format.name());
                }
                written.push((*format, served));
            }
            let of = |wanted: Format| written.iter().find(|(format, _)| *format == wanted).map(|(_, bytes)| &bytes[..]);
            if let [Some(rows), Some(csv), Some(ndjson), Some(arrow)] =
                [Format::Rows, Format::Csv, Format::Ndjson, Format::Arrow].map(of)
            {
                assert!(!same_numbers(rows, csv, ndjson, arrow).1.is_empty(), "{}", about.name);
            }
            for (format, start) in [(Format::Svg, &b"<svg"[..]), (Format::Png, b"\x89PNG")] {
                assert!(of(format).is_none_or(|picture| picture.starts_with(start)), "{}", about.name);
            }
            if has_formats {
                let refused = problem(server.post(&format!("{}?format=xml", route.path), &example).await).await;
                assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, "/format"), "{}", about.name);
                let html = server.send(Method::POST, route.path, Some(&text), &[("accept", "text/html")]).await;
                assert_eq!(problem(html).await.code, "not_acceptable", "{}", about.name);
            }
        }
    }
    assert!(server.client.contacts(None, None).await.unwrap().items.is_empty(), "nothing is stored");
}

/// The typed client sends and reads what the document describes.
#[tokio::test]
async fn the_typed_client_has_every_computation() {
    let (server, document) = (Server::start().await, document());
    macro_rules! agree {
        ($($path:literal $method:ident),*) => {$({
            let example = examples(&document, &document["paths"][$path]["post"]).remove(0);
            let typed = server.client.$method(&serde_json::from_value(example.clone()).unwrap()).await.unwrap();
            let plain: Value = server.post($path, &example).await.json().await.unwrap();
            assert_eq!(timeless(json!(typed)), timeless(plain), $path);
        })*
            let mut routes: Vec<&str> = entries().iter().filter_map(|entry| Some(entry.about.route?.path)).collect();
            for path in [$($path),*] {
                routes.retain(|route| *route != path);
            }
            assert!(routes.is_empty(), "the typed client has no {routes:?}");
        };
    }
    agree!("/simulate" simulate, "/accuracy" accuracy, "/protocols" protocol, "/cycle" cycle, "/fretting" fretting,
        "/wear" wear, "/sliders" sliders, "/rolling" rolling, "/profiles/fit" fit_profile, "/fit" fit_loops);
}
