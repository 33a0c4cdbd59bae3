#!/usr/bin/env perl
# SPDX-License-Identifier: LGPL-2.1-or-later
# Usage: doubtful.pl TABLE BILLET      in an empty current folder
#
# Each line of TABLE is a scene that billet must run, check, refuse or stop with these warnings and errors, or with no
# warning:
#
#   SCENE: EDIT -> KEYS      SCENE.prm of this folder or of its folders 'doubtful' and 'files', changed by EDIT
#                            (edit_scene.pl) if there is one, is run
#   check SCENE: EDIT -> KEYS    the same, with --check
#
# KEYS are separated by commas. 'key' must be printed; 'key = 10 +- 0.2' must have this measure, the first number in its
# text, to this part; 'key ~ words' must have these words; '! key' must not be printed; 'none' stands for no warning at
# all (notes may be printed), 'code 6' for the exit code. That is else 2 for 'bad-input', 3 for 'solution-failed', and 0. '#' begins a comment.
# After NAME := EDIT, NAME stands for EDIT.
use strict;
use warnings;
use File::Basename;

my $here = dirname(__FILE__);
require "$here/edit_scene.pl";

my ($table, $billet) = @ARGV;
my $lines = read_text($table);
enter_folder();

sub scene_text
{
  my ($name) = @_;
  my ($file) = grep { -e } map { "$here/$_$name.prm" } 'doubtful/', '', 'files/', '../../prm/';
  die "there is no scene '$name'\n" unless defined $file;
  return read_text($file);
}

# What is wrong with the messages; empty if nothing is.
sub fault
{
  my ($keys, $code, $said) = @_;
  my @told = $said =~ /^(?:warning|error)\[([\w-]+)\]/mg;
  my @said = $said =~ /^(?:note|warning|error)\[([\w-]+)\]/mg;
  my $expected_code =
      $keys =~ /\bcode (\d+)/ ? $1 : $keys =~ /\bbad-input\b/ ? 2 : $keys =~ /\bsolution-failed\b/ ? 3 : 0;
  return "exit code $code, not $expected_code" unless $code == $expected_code;
  for my $key (grep { !/^code / } split /\s*,\s*/, $keys)
  {
    if ($key eq 'none') { return "warns of @told" if @told }
    elsif ($key =~ /^! (.*)/) { return "warns of $1" if grep { $_ eq $1 } @told }
    else
    {
      my ($name, $value, $part, $words) = $key =~ /^([\w-]+)(?: = (\S+) \+- (\S+)| ~ (.+))?$/
          or die "$table: '$key' is no key\n";
      return "does not tell of $name, but of (@said)" unless grep { $_ eq $name } @said;
      return "$name does not say '$words'"
          unless !defined $words || $said =~ /^(?:warning|error)\[\Q$name\E\].*\Q$words\E/m;
      next unless defined $value;
      my ($found) = $said =~ /^warning\[\Q$name\E\]: [^\d\n]*?([\d.]+(?:e[-+]?\d+)?)/m;
      return "$name says $found, not $value" unless defined $found && abs($found - $value) <= $part * abs($value);
    }
  }
  return '';
}

my ($n_cases, $n_failed) = (0, 0);
my %short;
for (split /\n/, $lines)
{
  next if /^\s*(#|$)/;
  if (/^(\w+) := (.*)/)
  {
    $short{$1} = $2;
    next;
  }
  my ($check, $scene, $edits, $keys) = /^(check )?(\w+):\s*(.*?)\s*-> (.*)$/ or die "$table: no case: $_\n";
  my $expanded = join ' & ', map { $short{$_} // $_ } split / & /, $edits;
  my ($text) = edit(scene_text($scene), 'Output: Folder = r' . ++$n_cases . ($expanded && " & $expanded"));
  write_text('scene.prm', $text);
  my ($code, $said, $complained) = run($billet, $check ? '--check' : (), 'scene.prm');
  my $fault = fault($keys, $code, $said . $complained);
  print +($check // ''), "$scene: $edits: ", ($fault eq '' ? "ok\n" : "FAILED: $fault\n");
  ++$n_failed if $fault ne '';
}
print "$n_cases cases, $n_failed failed\n";
exit($n_failed ? 1 : 0);
