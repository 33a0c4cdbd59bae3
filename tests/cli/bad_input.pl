#!/usr/bin/env perl
# SPDX-License-Identifier: LGPL-2.1-or-later
# Usage: bad_input.pl TABLE COMMAND...      in an empty current folder; COMMAND is billet, or mpirun ... billet
#
# Each line of TABLE is a scene that billet must refuse:    EDIT -> MESSAGE
# EDIT of block.prm: see edit_scene.pl. MESSAGE: all that is printed, where '...' stands for anything, '@' for the file
# and the line of the last edit, '@{name}' for those of that subsection. 'allowed ...' alone stands for
# "@: 'Key' in 'Path': found 'value', allowed ...". After NAME := EDIT, NAME at the start of a line stands for EDIT.
# '#' begins a comment.
#
# Each must end with exit code 2, print the message once and nothing else, and leave every file as it was, results of a
# run before included. On one rank --check must say the same; tables named run_*.cases are of what --check may pass.
use strict;
use warnings;
use File::Basename;

my $here = dirname(__FILE__);
require "$here/edit_scene.pl";

my ($table, @command) = @ARGV;
my @runs = (['scene.prm']);
push @runs, ['--check', 'scene.prm'] if @command == 1 && basename($table) !~ /^run_/;
my $cases = read_text($table);

enter_folder();
mkdir 'no_history' and mkdir 'no_history/history.csv'; # a folder where a file should be
my $base = read_text("$here/block.prm");
write_text('scene.prm', $base);
my ($code, undef, $errors) = run($command[-1], 'scene.prm');
die "block.prm itself fails ($code): $errors\n" if $code;

my ($n_cases, $n_failed, %short) = (0, 0);
my $before = picture('scene.prm');
for (split /\n/, $cases)
{
  next if /^\s*(#|$)/;
  if (/^(\w+) := (.*)/)
  {
    $short{$1} = $2;
    next;
  }
  my ($edits, $expected) = /^(.*?)\s*-> (.*)$/ or die "$table: no '->' in: $_\n";
  my $name = $edits;
  $edits =~ s/^(\w+)(?= &|$)/$short{$1} \/\/ $1/e;
  my ($scene, $line, $path, $key, $value) = edit($base, $edits);
  write_text('scene.prm', $scene);

  $expected = "\@: '$key'" . ($path && " in '$path'") . ": found '$value', $expected" if $expected =~ /^allowed /;
  $expected =~ s/\@\{(.*?)\}/'scene.prm:' . line_of($scene, $1)/ge;
  $expected =~ s/\@/scene.prm:$line/g;
  my $pattern = join '.*', map { quotemeta } split /\.\.\./, $expected, -1;

  my @faults;
  for my $arguments (@runs)
  {
    my ($code, $output, $errors) = run(@command, @$arguments);
    my $fault =
        $code == 124 || $code == 137        ? "hangs\n"
      : $code != 2                          ? "exit code $code\n" . join('', (split /^/m, $output . $errors)[0 .. 7])
      : $output ne ''                       ? "prints:\n$output"
      : $errors !~ /^billet: $pattern\n\z/  ? "says:\n${errors}instead of:\nbillet: $expected\n"
      :                                       '';
    push @faults, "billet @$arguments $fault" if $fault;
    my $after = picture('scene.prm');
    my @changed = differences($before, $after);
    push @faults, 'writes over ' . @changed . " files, such as $changed[0]\n" if @changed;
    $before = $after;
  }
  print "$name: ", (@faults ? "FAILED: @faults" : "ok\n");
  ++$n_cases;
  ++$n_failed if @faults;
}
print "$n_cases cases, $n_failed failed\n";
exit($n_cases && !$n_failed ? 0 : 1);
