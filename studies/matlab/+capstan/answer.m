function values = answer (command, file, pairs)
  % CAPSTAN.ANSWER  All numbers of an answer of the program as a struct: what --json prints.
  result = [tempname(), '.json'];
  at_end = onCleanup (@() capstan.forget (result));
  capstan.program ([{command, file, '--json', '--progress', 'none', '-o', result}, capstan.options(pairs)]);
  values = jsondecode (fileread (result));
end
