% +capstan in Octave: what it returns is what the program prints, and errors say what the program says.
addpath (getenv ('CAPSTAN_MATLAB'));
configs = getenv ('CAPSTAN_CONFIGS');
recordings = fullfile (configs, 'recordings');

% place: the numbers of --json
found = capstan.place (fullfile (configs, 'quick.toml'), 'repetitions', 40);
[status, printed] = system ([getenv('CAPSTAN'), ' place ', configs, '/quick.toml --repetitions 40 --json --progress none']);
assert (status, 0);
assert (found, jsondecode (printed));
assert (found.scopes{1}.counts(1).sensor_count, 1);

% estimate: every node of the cable at every time, with its band
runs = capstan.estimate (fullfile (recordings, 'single-cable.csv'), 'segments', 10);
names = fieldnames (runs);
assert (numel (names), 1);
cable = runs.(names{1});
assert (numel (cable.t), 201);
channels = fieldnames (cable);
assert (numel (channels), 2 + 2 * 11);  % t, units; tension and half width at 11 nodes
for k = 1:numel (channels)
  if ~ any (strcmp (channels{k}, {'t', 'units'}))
    assert (size (cable.(channels{k})), [201, 1]);
    assert (all (isfinite (cable.(channels{k}))));
    assert (cable.units.(channels{k}), 'N');
  end
end

% diagnose: the run in which the hand moves fast
why = capstan.diagnose (fullfile (recordings, 'viscous-pair.csv'), 'runs', 2);
assert (why.ranked(1).effect, 'viscous_friction');
assert (why.ranked(1).probability > 0.5);

% errors carry the program's words; a name with a quote is a name
function fails_with (call, words)
  try
    call ();
  catch problem
    assert (! isempty (strfind (problem.message, words)), problem.message);
    return;
  end
  error ('no error, but should say "%s"', words);
end
fails_with (@() capstan.place ('it''s missing.toml'), 'it''s missing.toml');
fails_with (@() capstan.place (fullfile (configs, 'quick.toml'), 'repetition', 3), '--repetition');
fails_with (@() capstan.place (fullfile (configs, 'quick.toml'), 'repetitions'), 'pairs');
assert (capstan.options ({'fit_runs', [1 3], 'baselines', true, 'quiet', false, 'save', 'm.toml'}), ...
        {'--fit-runs', '1,3', '--baselines', '--save', 'm.toml'});
disp ('place, estimate, diagnose and their errors: as the program');
