function values = diagnose (recording, varargin)
  % CAPSTAN.DIAGNOSE  Why a bench disagrees with its model: the most probable causes of a recording's gap.
  %
  %   found = capstan.diagnose ('run7.csv')
  %   found = capstan.diagnose ('run7.csv', 'fit', [1 3], 'hold', [2 4], 'save', 'model.toml')
  %
  % A recording is NAME.csv with NAME.json beside it; `capstan import` makes one of a log. Options are those of `capstan diagnose`.
  % The struct has what --json prints: found.ranked (effect, probability), found.causes, found.channels.
  values = capstan.answer ('diagnose', recording, varargin);
end
