// Creates a contact, moves it, prints the stress under it, follows its events, and deletes it. The types are those of the service:
//
//     npm install openapi-fetch openapi-typescript@7 typescript@5 @types/node
//     npx openapi-typescript http://localhost:8080/openapi.json --output stickslip.ts
//     npx tsc && node client.js http://localhost:8080
import createClient from "openapi-fetch";
import type { components, paths } from "./stickslip.js";

type State = components["schemas"]["StateEvent"];
// The formats that this client reads, of those that the service can write.
type Media = "application/json" | "application/problem+json";

const service = process.argv[2] ?? "http://localhost:8080";
// With keys: headers: { Authorization: "Bearer KEY" }.
const stickslip = createClient<paths, Media>({ baseUrl: service });

// The data of a reply. A refusal is a typed document too, with the place of each fault.
function expect<T>(reply: { data?: T; error?: components["schemas"]["ProblemDocument"] }): T {
  if (reply.data === undefined) throw new Error(reply.error?.detail ?? "the reply is empty");
  return reply.data;
}

// The states of a contact as they come, from the first after a sequence on. A stream has no end of its own, so it is read
// line by line; generated clients read a reply whole.
async function* states(id: string, after: number): AsyncGenerator<State> {
  const reply = await fetch(`${service}/contacts/${id}/events`, { headers: { "Last-Event-ID": String(after) } });
  if (!reply.ok || reply.body === null) throw new Error(`${reply.status} ${reply.statusText}`);
  let text = "";
  for await (const bytes of reply.body.pipeThrough(new TextDecoderStream())) {
    text += bytes;
    for (let end = text.indexOf("\n\n"); end >= 0; end = text.indexOf("\n\n")) {
      const lines = text.slice(0, end).split("\n");
      text = text.slice(end + 2);
      const data = lines.find((line) => line.startsWith("data: "));
      if (lines.includes("event: state") && data) yield JSON.parse(data.slice(6)) as State;
    }
  }
}

const steel = { youngs_modulus: 2.1e11, poisson_ratio: 0.3 };
const { id } = expect(
  await stickslip.POST("/contacts", {
    body: {
      profile: { type: "sphere", radius: 0.01 },
      material: { bodies: [steel, steel] },
      friction: 0.3,
      preload: { normal_force: 10.0 },
    },
  }),
);
const params = { path: { id } };

for (const force of [1.5, -0.5]) {
  const moved = expect(await stickslip.POST("/contacts/{id}/move", { params, body: { force } }));
  console.log(`${moved.sequence}: ${moved.state.force} N at ${moved.state.displacement} m, ${moved.state.regime}`);
}

const { radius, shear } = expect(
  await stickslip.GET("/contacts/{id}/stress", { params: { ...params, query: { points: 5 } } }),
);
radius?.forEach((r, index) => console.log(`${r} m: ${shear?.[index]} Pa`));

// 4 N are more than friction carries: mu F_N is 3 N.
const refused = await stickslip.POST("/contacts/{id}/move", { params, body: { force: 4.0 } });
console.log(`refused: ${refused.error?.code}`);

for await (const event of states(id, 0)) {
  console.log(`event ${event.sequence}: ${event.state.force} N`);
  if (event.sequence === 2) break;
}
await stickslip.DELETE("/contacts/{id}", { params });
console.log("deleted");
process.exit();
