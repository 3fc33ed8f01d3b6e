#!/usr/bin/env bash
# The life of a contact in lines of curl: examples/curl.sh [URL]
set -euo pipefail
service=${1:-http://localhost:8080}

post() { curl -sSf "$service$1" -H 'content-type: application/json' -d "$2"; }

# A steel ball of 10 mm radius on a steel plane, under 10 N.
made=$(post /contacts '{
  "label": "from a shell",
  "profile": {"type": "sphere", "radius": 0.01},
  "material": {"bodies": [{"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}]},
  "friction": 0.3,
  "preload": {"normal_force": 10.0}
}')
id=$(sed 's/.*"id":"\([^"]*\)".*/\1/' <<<"$made")
echo "contact $id"

# Move to a force, back by half of it, and then along a path that leaves little stress.
post "/contacts/$id/move" '{"force": 1.5}' >/dev/null
post "/contacts/$id/move" '{"force": -0.75, "relative": true}' >/dev/null
post "/contacts/$id/path" '{"path": {"falling_amplitude": {"reversals": 5}}, "steps": "last"}' >/dev/null

# The history as a table, and the stress as rows for a spreadsheet.
curl -sSf "$service/contacts/$id/history?format=csv" | cut -d, -f1,3,4
curl -sSf "$service/contacts/$id/stress?points=5&format=csv"

# Plots.
folder=$(mktemp -d)
curl -sSf "$service/contacts/$id/stress?format=png" -o "$folder/stress.png"
curl -sSf "$service/contacts/$id/loop?points_per_move=40&format=svg" -o "$folder/loop.svg"
echo "plots in $folder"

# A client that has this version already gets a reply without a body.
tag=$(curl -sSf -o /dev/null -D - "$service/contacts/$id" | sed -n 's/^etag: \(.*\)\r$/\1/p')
curl -sSf -o /dev/null -w 'unchanged: %{http_code}\n' "$service/contacts/$id" -H "if-none-match: $tag"

curl -sSf -X DELETE "$service/contacts/$id" -w 'deleted: %{http_code}\n'
