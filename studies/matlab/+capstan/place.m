function values = place (config, varargin)
  % CAPSTAN.PLACE  Which sensors, and where: the search over all layouts that a configuration allows.
  %
  %   found = capstan.place ('my.toml')
  %   found = capstan.place ('my.toml', 'repetitions', 100, 'html', 'place.html')
  %
  % Options are those of `capstan place`; an underscore stands for a hyphen. The struct has what --json prints; with
  % [uncertainty] in the configuration found.recommendations and found.prices, else found.scopes.
  values = capstan.answer ('place', config, varargin);
end
