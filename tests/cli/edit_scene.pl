# SPDX-License-Identifier: LGPL-2.1-or-later
# What bad_input.pl and runs.pl share: scenes that differ from a base by an edit, runs with a time limit, and pictures
# of a folder. An edit is one or more of these, joined by ' & ':
#
#   Section: Key = value    sets the parameter in the subsection of that (last) name; without 'Section:' at the top level.
#                           Where the last name is not the only one of its kind: Body / Section
#   Section: - Key          takes its line away
#   Section: + text         adds lines (\n between them) at the subsection's start, at the top level at the file's end
#   Section: delete         takes the subsection away
use strict;
use warnings;
use File::Basename;
use File::Copy;

my $folder_of_tests = dirname(__FILE__);

# Seconds; ranks that wait for each other fail. Sanitizers take their time.
my $time_limit = $ENV{ASAN_OPTIONS} ? 900 : 60;
my $memory_limit = 8000000; # kB of addresses for each process; MPI's libraries alone want a good part of it

sub read_text
{
  my ($name) = @_;
  open my $in, '<:raw', $name or die "$name: $!\n";
  local $/;
  return scalar <$in>;
}

sub write_text
{
  my ($name, $text) = @_;
  open my $out, '>:raw', $name or die "$name: $!\n";
  print $out $text;
  close $out or die "$name: $!\n";
}

# A fresh folder with the files that scenes name.
sub enter_folder
{
  mkdir 'work' and chdir 'work' or die "work: $!\n";
  copy($_, '.') or die "$_: $!\n" for glob "$folder_of_tests/files/*";
}

# For each line the names of the subsections it stands in; a line that opens one stands in it.
sub paths
{
  my (@lines) = @_;
  my (@stack, @paths);
  for (@lines)
  {
    push @stack, $1 if /^\s*subsection\s+(.*?)\s*(?:#.*)?$/;
    push @paths, [@stack];
    pop @stack if /^\s*end\b/;
  }
  return @paths;
}

# Line number (from 1) where the subsection of this name opens.
sub line_of
{
  my ($text, $section) = @_;
  my @lines = split /\n/, $text;
  my @paths = map { join ' / ', @$_ } paths(@lines);
  my @found = grep { $lines[$_ - 1] =~ /^\s*subsection\s/ && "/ $paths[$_ - 1]" =~ m{/ \Q$section\E$} } 1 .. @lines;
  die "the scene has not one, but " . @found . " subsections '$section'\n" unless @found == 1;
  return $found[0];
}

# Returns the new text and, of the last edit: its line number, its path, its key and its value.
sub edit
{
  my ($text, $edits) = @_;
  my ($line, $path, $key, $value);
  for my $edit (split / & /, $edits)
  {
    my ($section, $change) = $edit =~ m{^([\w /]+): (.*)$}s ? ($1, $2) : ('', $edit);
    my @lines = split /\n/, $text;
    my @paths = map { join ' / ', @$_ } paths(@lines);
    my $begin = $section ? line_of($text, $section) : 0; # index of the first line in the section
    $path = $section ? $paths[$begin - 1] : '';
    $key = $value = undef;
    my $index;
    if ($change eq 'delete')
    {
      $index = $begin - 1;
      my $n = grep { "$_ / " =~ m{^\Q$path\E / } } @paths;
      splice @lines, $index, $n;
    }
    elsif ($change =~ /^\+ (.*)$/s)
    {
      $index = $section ? $begin : @lines;
      splice @lines, $index, 0, split(/\\n|\n/, $1);
    }
    else
    {
      (my $delete, $key, $value) = $change =~ /^(- )?(.*?)(?:\s*=\s*(.*))?$/s;
      ($index) = grep { $lines[$_] =~ /^\s*set\s+\Q$key\E\s*=/ && $paths[$_] eq $path } 0 .. $#lines;
      die "'$edit': there is nothing to take away\n" if $delete && !defined $index;
      splice @lines, $index // $begin, defined $index, $delete ? () : "set $key = $value";
      $index //= $begin;
    }
    $line = $index + 1;
    $text = join("\n", @lines) . "\n";
  }
  return ($text, $line, $path, $key, $value);
}

# Runs the command. Returns exit code, standard output and standard error without mpirun's remarks.
sub run
{
  my (@command) = @_;
  my $pid = fork() // die "fork: $!\n";
  if (!$pid)
  {
    open STDIN,  '<', '/dev/null';
    open STDOUT, '>', '../scene.stdout' or die;
    open STDERR, '>', '../scene.stderr' or die;
    # The sanitizer of addresses takes all of them for itself.
    my $limit_memory = $ENV{ASAN_OPTIONS} ? 'true' : "ulimit -v $memory_limit";
    my $limited = "$limit_memory && exec timeout --kill-after=5 $time_limit \"\$@\"";
    exec 'bash', '-c', $limited, 'bash', @command or die "bash: $!\n";
  }
  waitpid $pid, 0;
  my $code = $? & 127 ? 128 + ($? & 127) : $? >> 8;
  my $errors = read_text('../scene.stderr');
  $errors =~ s/^-{40,}\n.*?^-{40,}\n//msg;
  return ($code, read_text('../scene.stdout'), $errors);
}

# Every file below the current folder: its name, time and contents.
sub picture
{
  my ($skip) = @_;
  my %picture;
  my @todo = ('.');
  while (defined(my $name = shift @todo))
  {
    next if defined $skip && $name eq "./$skip";
    $picture{$name} = -d $name ? 'folder' : (stat $name)[9] . read_text($name);
    push @todo, glob("$name/*") if -d $name;
  }
  return \%picture;
}

# Names of files that differ between two pictures.
sub differences
{
  my ($a, $b) = @_;
  my %all = (%$a, %$b);
  return grep { ($a->{$_} // '') ne ($b->{$_} // '') } sort keys %all;
}

1;
