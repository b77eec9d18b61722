% Races Octave's fsolve on the steps of `capstan simulate` motions: steps a second, share converged, and how
% far its tensions are from capstan's. The same system as scipy_fsolve.py; see README.md.
%
%   octave-cli octave_fsolve.m SECONDS CASE=MOTION.csv ...
1;

% The paper's Sec. III.B: Table I, 40 N of preload, a 40 N/m spring between the distal end and a wall.
function p = parameters ()
  p.length_m = 2.0;
  p.bend_radius_m = 0.28;
  p.axial_stiffness_N = 2000.0;
  p.dynamic_friction = 0.21;
  p.static_friction = 0.63;
  p.preload_N = 40.0;
  p.spring_N_per_m = 40.0;
  p.converged_N = 1e-9;
  p.first_step = 1001;       % the second cycle, after the first has settled
  p.steps_per_cycle = 1000;
  p.stride = 619;            % prime to the cycle, near its golden section: any few steps lie evenly
end

% States before and after every step, and which segments slid.
function motion = read_motion (path)
  file = fopen (path);
  nodes = numel (strfind (fgetl (file), "tension_"));
  columns = textscan (file, ["%f %f %s %s" repmat(" %f", 1, 5 + 2 * nodes)], "Delimiter", ",");
  fclose (file);
  motion.tension_N = [columns{10:9 + nodes}];
  motion.displacement_m = [columns{10 + nodes:9 + 2 * nodes}];
  motion.segments = nodes - 1;
  motion.slid = false (rows (motion.tension_N), motion.segments);
  for row = 1:rows (motion.tension_N)
    motion.slid(row, 1:max (columns{5}(row) - 1, 0)) = true;
    motion.slid(row, motion.segments - max (columns{6}(row) - 1, 0) + 1:end) = true;
  end
end

% One step as a nonlinear system: unknowns y_i, the shift of the middle of segment i over 2 h, in newtons.
function step = step_of (motion, number)
  p = parameters ();
  before = number;  % row 1 is sample 0
  step.spring_N_per_m = p.spring_N_per_m;
  step.before_N = motion.tension_N(before, :)';
  step.h = 0.5 * p.length_m / motion.segments / p.axial_stiffness_N;
  step.moved_m = motion.displacement_m(before + 1, 1) - motion.displacement_m(before, 1);
  wrap_rad = p.length_m / motion.segments / p.bend_radius_m;
  step.sliding_limit = tanh (0.5 * p.dynamic_friction * wrap_rad);
  step.limit = repmat (tanh (0.5 * p.static_friction * wrap_rad), motion.segments, 1);
  step.limit(motion.slid(before, :)) = step.sliding_limit;
  step.spring_off_N = p.preload_N - p.spring_N_per_m * motion.displacement_m(before, end) - step.before_N(end);
end

function tension_N = tension_of (step, y_N)
  change_N = [2 * y_N(1) - step.moved_m / step.h; ...
              diff(y_N); ...
              (step.spring_off_N - 2 * step.h * step.spring_N_per_m * y_N(end)) / (1 + step.h * step.spring_N_per_m)];
  tension_N = step.before_N + change_N;
end

function [friction_N, most_N] = friction_of (step, y_N)
  tension_N = tension_of (step, y_N);
  friction_N = diff (tension_N);
  most_N = step.limit .* (tension_N(2:end) + tension_N(1:end - 1));
end

function residual_N = residual_of (step, y_N)
  [friction_N, most_N] = friction_of (step, y_N);
  residual_N = friction_N - min (max (friction_N + y_N, -most_N), most_N);
end

% Tensions; empty where fsolve does not converge.
function tension_N = solve (step, start)
  tension_N = [];
  segments = numel (step.limit);
  y_N = zeros (segments, 1);
  if (strcmp (start, "kick"))
    y_N = (1 - ((0:segments - 1)' + 0.5) / segments) * step.moved_m / (2 * step.h);
  end
  options = optimset ("TolX", 1e-14, "TolFun", 1e-14, "MaxIter", 400);
  while (true)
    try
      [y_N, residual_N] = fsolve (@(y) residual_of (step, y), y_N, options);
    catch
      return;  % it gave up on a matrix of its own
    end
    if (! (max (abs (residual_N)) <= parameters ().converged_N))
      return;
    end
    % Held by mu_s and yet sliding: mu_d from now on, and again.
    [friction_N, most_N] = friction_of (step, y_N);
    released = abs (friction_N + y_N) >= most_N & step.limit > step.sliding_limit;
    if (! any (released))
      tension_N = tension_of (step, y_N);
      return;
    end
    step.limit(released) = step.sliding_limit;
  end
end

function [rate, share, largest_difference_N] = race (motion, start, seconds)
  p = parameters ();
  offset = steps = converged = spent_s = largest_difference_N = 0;
  while (spent_s < seconds)
    number = p.first_step + offset;
    step = step_of (motion, number);
    began = tic ();
    tension_N = solve (step, start);
    spent_s += toc (began);
    steps += 1;
    offset = mod (offset + p.stride, p.steps_per_cycle);
    if (isempty (tension_N))
      continue;
    end
    converged += 1;
    difference_N = max (abs (tension_N' - motion.tension_N(number + 1, :)));
    largest_difference_N = max (largest_difference_N, difference_N);
  end
  rate = steps / spent_s;
  share = converged / steps;
end

warning ("off", "all");
words = argv ();
printf ("Steps a second of Octave fsolve; share converged to 1e-9 N; largest difference to capstan.\n\n");
printf ("%-5s  %8s  %5s  %11s  %9s  %12s\n", "case", "segments", "start", "steps/s", "converged", "difference");
for k = 2:numel (words)
  named = strsplit (words{k}, "=");
  motion = read_motion (named{2});
  for start = {"warm", "kick"}
    [rate, share, difference_N] = race (motion, start{1}, str2double (words{1}));
    printf ("%-5s  %8d  %5s  %11.3g  %8.1f%%  %10.1e N\n", named{1}, motion.segments, start{1}, rate, ...
            100 * share, difference_N);
  end
end
