function program (words)
  % CAPSTAN.PROGRAM  Run the program capstan with a cell array of words; an error carries what it said.
  %
  %   capstan.program ({'config', 'check', 'my.toml'})
  %
  % The program is found on the PATH, or where the environment variable CAPSTAN says.
  name = getenv ('CAPSTAN');
  if isempty (name)
    name = 'capstan';
  end
  command = '';
  for k = 1:numel (words)
    command = [command, ' ', quoted(words{k})];
  end
  said = [tempname(), '.txt'];
  at_end = onCleanup (@() capstan.forget (said));
  % MATLAB's own libraries are not those that the program was built with.
  status = system (['LD_LIBRARY_PATH= ', quoted(name), command, ' 2> ', quoted(said), ' > /dev/null']);
  if status ~= 0
    error ('capstan:failed', '%s', strtrim (fileread (said)));
  end
end

function text = quoted (text)
  text = ['''', strrep(char (text), '''', '''\'''''), ''''];
end
