function words = options (pairs)
  % CAPSTAN.OPTIONS  Names and values as options of the program, a cell array of words.
  %
  %   capstan.options ({'repetitions', 100, 'fit', [1 3], 'baselines', true})
  %
  % gives --repetitions 100 --fit 1,3 --baselines. An underscore in a name stands for a hyphen.
  if mod (numel (pairs), 2) ~= 0
    error ('capstan:options', 'options come in pairs of a name and a value');
  end
  words = {};
  for k = 1:2:numel (pairs)
    name = ['--', strrep(pairs{k}, '_', '-')];
    value = pairs{k + 1};
    if islogical (value)
      if value
        words{end + 1} = name;
      end
    elseif isnumeric (value)
      numbers = sprintf ('%.17g,', value);
      words = [words, {name, numbers(1:end - 1)}];
    else
      words = [words, {name, char(value)}];
    end
  end
end
