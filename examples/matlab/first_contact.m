% A friction loop in MATLAB or Octave: first_contact(url) returns displacement (m) and force (N) of the loop.
%
%   [displacement, force] = first_contact('http://localhost:8080');
%   plot(1e9 * displacement, force)
%
% MATLAB's webwrite sends a struct as JSON. That of Octave sends forms alone, so that Octave calls curl.
function [displacement, force] = first_contact(url)
    if nargin < 1
        url = 'http://localhost:8080';
    end
    contact.profile = struct('type', 'sphere', 'radius', 0.01);
    steel = struct('youngs_modulus', 2.1e11, 'poisson_ratio', 0.3);
    contact.material.bodies = {steel, steel};
    contact.friction = 0.3;
    contact.preload.normal_force = 10;
    path.displacement = 1e-7 * [linspace(0, 1, 21), linspace(0.95, -1, 40), linspace(-0.95, 1, 40)];
    reply = post([url, '/simulate'], struct('contact', contact, 'path', path));
    displacement = [reply.steps.displacement];
    force = [reply.steps.force];
end

function reply = post(url, request)
    if ~exist('OCTAVE_VERSION', 'builtin')
        reply = webwrite(url, request, weboptions('MediaType', 'application/json'));
        return
    end
    file = [tempname(), '.json'];
    stream = fopen(file, 'w');
    fputs(stream, jsonencode(request));
    fclose(stream);
    [status, text] = system(['curl -sS --fail-with-body -H "content-type: application/json" --data-binary @', file, ' ', url]);
    delete(file);
    if status ~= 0
        error('stickslip: %s', text);
    end
    reply = jsondecode(text);
end
