function forget (file)
  % CAPSTAN.FORGET  Delete a temporary file, if it is there.
  if exist (file, 'file')
    delete (file);
  end
end
