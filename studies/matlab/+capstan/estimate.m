function runs = estimate (recording, varargin)
  % CAPSTAN.ESTIMATE  The tension at every node over time, from a recording's sensors.
  %
  %   runs = capstan.estimate ('run7.csv')
  %   runs = capstan.estimate ('run7.csv', 'model', 'model.toml', 'segments', 20)
  %
  % Options are those of `capstan estimate`. The struct has a field for each cable of each run: t [s], the tension at
  % each place [N] with the half width of its 95% band, and units.
  result = [tempname(), '.mat'];
  at_end = onCleanup (@() capstan.forget (result));
  capstan.program ([{'estimate', recording, '-o', result}, capstan.options(varargin)]);
  runs = load (result);
end
